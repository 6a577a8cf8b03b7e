/* Draws one picture in turns with each program and mode that is compared. */
#ifndef BENCH_FRAME_SIDES_H
#define BENCH_FRAME_SIDES_H

#include "bench/frame.h"

/* Loads the scene, builds its trees and makes the reference. */
WHIT_CHECK whit_result frame_prepare(struct frame *frame);
/* Runs all sides in turns, once as a warm-up and then as often as the bench has runs. */
WHIT_CHECK whit_result frame_run(struct frame *frame);
/* Device memory for drawing the picture, in MB, without that of the scene and the pixels. */
WHIT_CHECK whit_result frame_memory(const struct frame *frame, double *megabytes);
void frame_finish(struct frame *frame);

#endif

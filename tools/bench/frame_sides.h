/* Draws one picture in turns with each program and mode that is compared. */
#ifndef BENCH_FRAME_SIDES_H
#define BENCH_FRAME_SIDES_H

#include "bench/frame.h"

/* The scene, its trees and the reference. */
WHIT_CHECK whit_result frame_prepare(struct frame *frame);
/* All sides, once before the clock counts and then as often as the bench has runs. */
WHIT_CHECK whit_result frame_run(struct frame *frame);
/* Device memory of the picture beyond what the scene and the pixels take, in MB. */
WHIT_CHECK whit_result frame_memory(const struct frame *frame, double *megabytes);
void frame_finish(struct frame *frame);

#endif

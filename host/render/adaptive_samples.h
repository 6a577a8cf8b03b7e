/* Which pixels each pass of an adaptive picture draws; tiles.c makes the passes. */
#ifndef RENDER_ADAPTIVE_SAMPLES_H
#define RENDER_ADAPTIVE_SAMPLES_H

#include "render/renderer.h"

/* Sets the entry in `levels` to `level` for every pixel of `color` that differs from one of its 8
   neighbours by more than `contrast` in some channel as displayed (linear, clamped to 0..1).
   Returns the number of such pixels. */
uint64_t adaptive_mark(const struct image *color, double contrast, uint8_t level, uint8_t *levels);
/* Writes the list of the chunk's pixels that the pass draws; chunk->listed is their number. */
WHIT_CHECK whit_result adaptive_list(struct target *target, const struct progress *progress,
                                     struct gpu_chunk *chunk);
/* Whether the pass draws pixel `index` of the picture. */
bool adaptive_draws(const struct progress *progress, size_t index);

#endif

/* Which pixels each pass of an adaptive picture draws; tiles.c makes the passes. */
#ifndef RENDER_ADAPTIVE_SAMPLES_H
#define RENDER_ADAPTIVE_SAMPLES_H

#include "render/renderer.h"

/* Sets the entry in `levels` to `level` for every pixel of `color` that differs from one of its 8
   neighbours by more than `contrast` in some channel as displayed (linear, clamped to 0..1).
   Returns the number of such pixels. */
uint64_t adaptive_mark(const struct image *color, double contrast, uint8_t level, uint8_t *levels);
/* Writes the list of the pixels that the pass draws in the picture's blocks from `first_block` to
   `end_block` - 1, block by block; `count`: their number. */
WHIT_CHECK whit_result adaptive_list(struct target *target, const struct progress *progress,
                                     uint32_t first_block, uint32_t end_block, uint32_t *count);
/* Whether the pass draws pixel `index` of the picture. */
bool adaptive_draws(const struct progress *progress, size_t index);

#endif

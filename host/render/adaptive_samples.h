/* Everything around the passes of an adaptive picture, which tiles.c makes. */
#ifndef RENDER_ADAPTIVE_SAMPLES_H
#define RENDER_ADAPTIVE_SAMPLES_H

#include "render/renderer.h"

/* Gives every pixel of `color` that differs from one of its 8 neighbours by more than `contrast`,
   in some channel as displayed (linear, 0..1), the level `level`. The number of such pixels. */
uint64_t adaptive_mark(const struct image *color, double contrast, uint8_t level, uint8_t *levels);
/* Lists the pixels of the chunk that the pass draws: their number is chunk->listed. */
WHIT_CHECK whit_result adaptive_list(struct target *target, const struct progress *progress,
                                     struct gpu_chunk *chunk);
/* Whether pixel `index` of the picture is drawn by the pass. */
bool adaptive_draws(const struct progress *progress, size_t index);

#endif

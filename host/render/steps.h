/* Pictures in steps, from coarse to fine. */
#ifndef RENDER_STEPS_H
#define RENDER_STEPS_H

#include "render/renderer.h"

/* All pixels of the rows that are drawn. */
struct lattice lattice_whole(const struct renderer *renderer);
/* gpu_chunk.lattice */
uint32_t lattice_word(const struct lattice *lattice);
bool steps_are_wanted(const struct renderer *renderer);
/* Shows what is drawn of the picture, every `spacing`-th pixel of rows and columns. */
WHIT_CHECK whit_result steps_give(const struct renderer *renderer, uint32_t spacing);
/* The picture in steps, with params.step after each but the last. */
WHIT_CHECK whit_result steps_render(struct renderer *renderer, struct progress *progress);

#endif

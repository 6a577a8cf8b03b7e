/* Pictures in steps, from coarse to fine. */
#ifndef RENDER_STEPS_H
#define RENDER_STEPS_H

#include "render/renderer.h"

/* The lattice of all pixels, down to the last row that is drawn. */
struct lattice lattice_whole(const struct renderer *renderer);
/* Packs a lattice as gpu_chunk.lattice. */
uint32_t lattice_word(const struct lattice *lattice);
bool steps_are_wanted(const struct renderer *renderer);
/* Gives params.step the picture as far as it is drawn: every `spacing`-th pixel of rows and
   columns. */
WHIT_CHECK whit_result steps_give(const struct renderer *renderer, uint32_t spacing);
/* Draws the picture in steps, and calls params.step after each but the last. */
WHIT_CHECK whit_result steps_render(struct renderer *renderer, struct progress *progress);

#endif

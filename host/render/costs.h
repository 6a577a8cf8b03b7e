/* Costs of rays. These functions do nothing without params.count. */
#ifndef RENDER_COSTS_H
#define RENDER_COSTS_H

#include "render/renderer.h"

void costs_clear(struct renderer *renderer);
/* Adds up what the kernels counted for one sample of `chunk`, which was just drawn. Call it before
   the next chunk, which counts in the same slots. */
WHIT_CHECK whit_result costs_add(struct target *target, const struct gpu_chunk *chunk);

#endif

/* What rays cost. All of it does nothing without params.count. */
#ifndef RENDER_COSTS_H
#define RENDER_COSTS_H

#include "render/renderer.h"

WHIT_CHECK whit_result costs_create(struct target *target);
void costs_clear(struct renderer *renderer);
/* Takes over what the kernels counted for one sample of `chunk`, which was just drawn: the next
   chunk counts in the same slots. */
WHIT_CHECK whit_result costs_add(struct target *target, const struct gpu_chunk *chunk);

#endif

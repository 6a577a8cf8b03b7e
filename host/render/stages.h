/* Draws one sample of a tile in stages. */
#ifndef RENDER_STAGES_H
#define RENDER_STAGES_H

#include "render/renderer.h"

/* Traces all rays of one sample of a chunk. *longest_ms: raised to the time of its longest
   submission. */
WHIT_CHECK whit_result stages_sample(struct target *target, const struct gpu_chunk *chunk,
                                     const struct progress *progress, double *longest_ms);

uint64_t stages_generation_offset(uint32_t generation);

#endif

/* Pictures in stages. */
#ifndef RENDER_STAGES_H
#define RENDER_STAGES_H

#include "render/renderer.h"

/* All rays of one sample of one chunk. *longest_ms: of its submissions. */
WHIT_CHECK whit_result stages_sample(struct target *target, const struct gpu_chunk *chunk,
                                     const struct progress *progress, double *longest_ms);

uint64_t stages_generation_offset(uint32_t generation);

#endif

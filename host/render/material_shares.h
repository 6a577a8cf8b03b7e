/* The share of each material in the hits of a shading kernel. */
#ifndef RENDER_MATERIAL_SHARES_H
#define RENDER_MATERIAL_SHARES_H

#include "render/renderer.h"

/* Counts the hits of each material in the tile that was just drawn; its queues must not have
   changed since. `camera_rays`: pixels of the tile. WHIT_ERROR_MEMORY, logged. */
WHIT_CHECK whit_result material_shares_add(struct target *target,
                                           const struct gpu_generation *generations,
                                           uint32_t generation_count, uint32_t camera_rays);
/* Forgets the counts: call it before another picture. */
void material_shares_clear(struct target *target);
/* Fills in stats->shares. */
void material_shares_get(const struct target *target, whit_stats *stats);

#endif

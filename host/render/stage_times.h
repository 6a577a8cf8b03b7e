/* Times of the stages: target->stats.stages, and rays_shadow with it. */
#ifndef RENDER_STAGE_TIMES_H
#define RENDER_STAGE_TIMES_H

#include "render/renderer.h"

void stage_times_begin(struct target *target);
/* A submission begins, whose first span is open. */
void stage_times_submission(struct target *target);
/* What is recorded from here on belongs to `row`. */
void stage_times_next(struct target *target, uint32_t row);
/* The submission is done. */
void stage_times_take(struct target *target);
/* A tile is done, of `generations`, with so many items that waited. */
WHIT_CHECK whit_result stage_times_end(struct target *target, const struct gpu_chunk *chunk,
                                       uint32_t generations, uint32_t deferred);
/* Fills in names, and the times of all items. */
void stage_times_scale(const struct renderer *renderer, whit_stats *stats);

#endif

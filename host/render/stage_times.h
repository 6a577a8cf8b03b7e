/* Times of the stages: fills in target->stats.stages and rays_shadow. */
#ifndef RENDER_STAGE_TIMES_H
#define RENDER_STAGE_TIMES_H

#include "render/renderer.h"

/* Whether each light has a row of its own; else all share the first one. */
bool stage_times_by_light(const struct renderer *renderer);
void stage_times_begin(struct target *target);
/* Call it when a submission begins, with its first span open. */
void stage_times_submission(struct target *target);
/* Counts the time of what is recorded from here on in `row` (RENDER_STAGE_*). */
void stage_times_next(struct target *target, uint32_t row);
/* Adds up the times of the submission, which is done. */
void stage_times_take(struct target *target);
/* Counts the items of a tile that is done: `generations` of rays, and `deferred` items of second
   kernels. */
WHIT_CHECK whit_result stage_times_end(struct target *target, const struct gpu_chunk *chunk,
                                       uint32_t generations, uint32_t deferred);
/* Fills in the names of stages, and times for all items, scaled up from the timed ones. */
void stage_times_scale(const struct renderer *renderer, whit_stats *stats);

#endif

/* Which constants a scene gets, and the pipelines made with them. */
#ifndef RENDER_VARIANTS_H
#define RENDER_VARIANTS_H

#include "device/pipeline.h"
#include "render/renderer.h"

struct gpu_spec variant_spec(const struct target *target);
/* The same with every effect. */
struct gpu_spec variant_general_spec(const struct target *target);
/* Every effect that the renderer's buffers allow and its params do not remove. */
struct gpu_spec variant_async_spec(const struct target *target);
/* Classes of materials that have shading kernels of their own. */
uint32_t variant_classes(const struct target *target);
/* Whether one kernel draws what has several elsewhere: renderer->few_kernels, and probes. */
bool variant_few_kernels(const struct target *target);
/* Whether the shading kernel with `spec` sends rays on: CALLS_RAYS of bind/queues.glsl. */
bool variant_calls_rays(const struct gpu_spec *spec);
/* Whether rays that floats leave open wait for a dispatch of their own: at NUMERICS_EXACT, unless
   they are counted or probed, which is to tell of every ray at once. */
bool variant_has_deferred(const struct target *target);
/* Whether STAGE_HIT_FETCH and STAGE_HIT_CALL may stand in for STAGE_HIT, for which there are rows
   then, and whether they do: a shade() that reads what is looked up in textures. Drivers compile
   its part in half of the time; without textures they gain nothing. */
bool variant_can_split_hits(const struct target *target);
bool variant_splits_hits(const struct target *target);
/* Rows of 16 bytes of a hit: HIT_ROWS of bind/queues.glsl. */
uint32_t variant_hit_rows(const struct renderer *renderer);
/* What is needed to make the pipelines of a stage; stands alone, and is not to be copied or moved.
 */
struct variant_job {
    struct gpu_spec spec;
    enum binding_kind kinds[BIND_STAGES_COUNT];
    struct pipeline_params params;
};
/* Makes pass->pipeline, and pass->deferred where rays may be deferred. */
WHIT_CHECK whit_result variant_job_run(struct device *device, const struct variant_job *job,
                                       struct pass *pass);
/* Whether a kernel leaves rays to a second one that has exact integers, and the constants of that.
 */
bool variant_defers(const struct pipeline_params *params, struct gpu_spec *spec);
/* `spec`: of the set of stages, which has `classes` shading kernels. */
void variant_job_init(const struct target *target, const struct gpu_spec *spec, uint32_t classes,
                      enum stage stage, struct variant_job *job);
/* Makes the binding sets of the pass. */
WHIT_CHECK whit_result variant_bind_stage(const struct target *target, struct pass *pass);
/* `beams`: for rays that start at one point, which then needs renderer->wide and
   variant_has_beams. */
WHIT_CHECK whit_result variant_create_trace(struct renderer *renderer, bool any, bool beams,
                                            struct pass *pass);
/* The kernel that runs the tests of params.shader, into `found`. */
WHIT_CHECK whit_result variant_create_tests(const struct target *target, struct buffer *found,
                                            struct pass *pass);
bool variant_has_beams(const struct renderer *renderer);
/* CAMERA_* that kernels are made for. */
uint32_t variant_camera(const struct renderer *renderer);
void pass_finish(struct pass *pass);
/* Keeps the pipeline. */
void pass_unbind(struct pass *pass);
void passes_finish(struct renderer *renderer);

#endif

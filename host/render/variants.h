/* Specialization constants for a scene, and the pipelines made with them. */
#ifndef RENDER_VARIANTS_H
#define RENDER_VARIANTS_H

#include "device/pipeline.h"
#include "render/renderer.h"

/* SPEC_LIGHTS_EACH where lights share hits (lights_share_hits): a lit hit is read, and its sum
   stored, once for all lights of a dispatch. More would gain little, and a submission may take 100
   ms. */
enum { LIGHTS_EACH = 8 };

struct gpu_spec variant_spec(const struct target *target);
/* The same, with every effect. */
struct gpu_spec variant_general_spec(const struct target *target);
/* Every effect that the renderer's buffers allow and its params do not remove. */
struct gpu_spec variant_async_spec(const struct target *target);
/* Number of material classes with a shading kernel of their own: 1 or CLASSES_MAX. */
uint32_t variant_classes(const struct target *target);
/* Whether one kernel serves several stages and all materials: renderer->few_kernels, or a probe. */
bool variant_few_kernels(const struct target *target);
/* Whether STAGE_SHADE_DIRECT pays, in a set of kernels with `spec` and as many classes: where
   shadow rays go one by one, and most hits have one for each light. */
bool variant_lights_directly(const struct target *target, const struct gpu_spec *spec,
                             uint32_t classes);
/* Whether the shading kernel with `spec` sends rays on, as CALLS_RAYS of bind/queues.glsl. */
bool variant_calls_rays(const struct gpu_spec *spec);
/* Whether rays whose hits floats leave open are deferred to a second dispatch: at NUMERICS_EXACT,
   unless rays are counted or probed, where one kernel must know all of a ray. */
bool variant_has_deferred(const struct target *target);
/* Whether STAGE_HIT_FETCH and STAGE_HIT_CALL may stand in for STAGE_HIT (there are then rows for
   them), and whether they do. They do for a shade() that reads values from textures: drivers
   compile STAGE_HIT_CALL in half the time. Without textures nothing is gained. */
bool variant_can_split_hits(const struct target *target);
bool variant_splits_hits(const struct target *target);
/* Rows of 16 bytes that a hit has: HIT_ROWS of bind/queues.glsl. */
uint32_t variant_hit_rows(const struct gpu_spec *spec);
/* Everything that is needed to make the pipelines of a stage. It points into itself: do not copy or
   move it. */
struct variant_job {
    struct gpu_spec spec;
    enum binding_kind kinds[BIND_STAGES_COUNT];
    struct pipeline_params params;
};
/* Makes pass->pipeline, and pass->deferred if rays may be deferred. */
WHIT_CHECK whit_result variant_job_run(struct device *device, const struct variant_job *job,
                                       struct pass *pass);
/* Whether a kernel defers rays to a second kernel with exact integers. *spec: the constants of
   that. */
bool variant_defers(const struct pipeline_params *params, struct gpu_spec *spec);
/* Prepares the pipelines of a stage. `spec`: the constants of the whole set, which has `classes`
   shading kernels. */
void variant_job_init(const struct target *target, const struct gpu_spec *spec, uint32_t classes,
                      enum stage stage, struct variant_job *job);
/* Makes the binding sets of the pass. */
WHIT_CHECK whit_result variant_bind_stage(const struct target *target, struct pass *pass);
/* Makes the kernel for batches of rays. `beams`: for packets of rays that start at one point, which
   needs renderer->wide and variant_has_beams. */
WHIT_CHECK whit_result variant_create_trace(struct renderer *renderer, bool any, bool beams,
                                            struct pass *pass);
/* Makes the kernel that runs the tests of params.shader and writes the results to `found`. */
WHIT_CHECK whit_result variant_create_tests(const struct target *target, struct buffer *found,
                                            struct pass *pass);
bool variant_has_beams(const struct renderer *renderer);
/* The CAMERA_* that kernels are made for. */
uint32_t variant_camera(const struct renderer *renderer);
void pass_finish(struct pass *pass);
/* Destroys the binding sets, and keeps the pipelines. */
void pass_unbind(struct pass *pass);
void passes_finish(struct renderer *renderer);
/* Unbinds the kernels of pictures and probes, and drops those of ray batches. */
void passes_unbind(struct renderer *renderer);

#endif

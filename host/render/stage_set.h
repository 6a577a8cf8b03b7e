/* The kernels of a picture in stages. */
#ifndef RENDER_STAGE_SET_H
#define RENDER_STAGE_SET_H

#include "render/variants.h"

/* Everything that is needed to make a set of kernels. It points into itself: do not copy or move
   it. */
struct stages_job {
    struct gpu_spec spec;
    uint32_t classes;
    bool asks, asks_directly;   /* as in struct stage_set */
    bool wanted[STAGE_COUNT];   /* whether the stage gets a kernel of its own */
    enum stage of[STAGE_COUNT]; /* as in struct stage_set */
    struct variant_job stages[STAGE_COUNT];
};
/* `own`: kernels for the scene; otherwise general ones with `spec`. `few`: one kernel for stages
   that differ only by their generation. */
void stages_job_init(const struct target *target, const struct gpu_spec *spec, bool own, bool few,
                     struct stages_job *job);
WHIT_CHECK whit_result stages_job_run(struct device *device, const struct stages_job *job,
                                      struct stage_set *out);
/* Replaces the target's set by `set`, which is empty afterwards, and binds it. */
WHIT_CHECK whit_result stages_take(struct target *target, struct stage_set *set);
/* If there is a set: makes those of its kernels anew that differ since renderer->params.shader has
   replaced `before`. After an error there is no set. */
WHIT_CHECK whit_result stages_replace(struct target *target, const whit_shader *before);
/* Makes and binds the scene's own set if there is none. */
WHIT_CHECK whit_result stages_compile(struct target *target);
/* Translates the kernels of a set that was just made and bound to machine code on two cores, if the
   driver would use one core and its cache has none of this code. Errors are the device's. After a
   request to stop, the remaining kernels are translated when they are dispatched. */
WHIT_CHECK whit_result translation_share(struct target *target, const struct stages_job *job);
/* Makes the kernels that were put off for params.few_pixels once that is no longer set, and those
   that take the place of STAGE_SHADE_DIRECT once they are needed; binds the set, which must exist.
 */
WHIT_CHECK whit_result stages_complete(struct target *target);
/* Binds the set to the current buffers, if it is not bound. */
WHIT_CHECK whit_result stages_bind(struct target *target);
bool stage_set_is_made(const struct stage_set *set);
void stages_unbind(struct stages *stages);
void stage_set_finish(struct stage_set *set);

#endif

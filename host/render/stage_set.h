/* The kernels of a picture in stages. */
#ifndef RENDER_STAGE_SET_H
#define RENDER_STAGE_SET_H

#include "render/variants.h"

/* What is needed to make a set of kernels; stands alone, and is not to be copied or moved. */
struct stages_job {
    struct gpu_spec spec;
    uint32_t classes;
    bool asks;                  /* as of a set */
    bool wanted[STAGE_COUNT];   /* a kernel of its own */
    enum stage of[STAGE_COUNT]; /* as of a set */
    struct variant_job stages[STAGE_COUNT];
};
/* `own`: the kernels for the scene, else general ones with `spec`. `few`: one kernel for stages
   that differ by their generation alone. */
void stages_job_init(const struct target *target, const struct gpu_spec *spec, bool own, bool few,
                     struct stages_job *job);
WHIT_CHECK whit_result stages_job_run(struct device *device, const struct stages_job *job,
                                      struct stage_set *out);
/* Takes over a set, which is empty afterwards, in place of the one that there was. */
WHIT_CHECK whit_result stages_take(struct target *target, struct stage_set *set);
/* Where there is a set: makes those of its kernels anew that are others since
   renderer->params.shader is in the place of `before`. After an error there is none. */
WHIT_CHECK whit_result stages_replace(struct target *target, const whit_shader *before);
/* Makes the scene's own set where there is none. */
WHIT_CHECK whit_result stages_compile(struct target *target);
/* Makes what few_pixels of the parameters has put off, where they have it no more, and binds the
   set, which there is. */
WHIT_CHECK whit_result stages_complete(struct target *target);
/* Binds the set to the buffers that there are, where it is not bound. */
WHIT_CHECK whit_result stages_bind(struct target *target);
bool stage_set_is_made(const struct stage_set *set);
bool stages_are_made(const struct target *target);
void stages_unbind(struct stages *stages);
void stage_set_finish(struct stage_set *set);

#endif

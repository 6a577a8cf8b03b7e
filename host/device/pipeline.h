/* Compute pipelines, and sets of buffers bound to them. */
#ifndef DEVICE_PIPELINE_H
#define DEVICE_PIPELINE_H

#include "device/device.h"
#include "whit/whit_program.h"

enum binding_kind { BINDING_NONE, BINDING_STORAGE, BINDING_TEXELS };

enum { REWRITE_WHY_BYTES = 160 };

/* Replaces a kernel by another one before its constants are filled in: *out is malloc()ed. On
   WHIT_ERROR_INPUT `why` has the reason. Several threads may call it at once. */
typedef whit_result pipeline_rewrite(const void *user, const uint32_t *words, size_t word_count,
                                     uint32_t **out, size_t *out_words,
                                     char why[REWRITE_WHY_BYTES]);

struct pipeline_params {
    const uint32_t *spirv;
    size_t spirv_bytes;
    pipeline_rewrite *rewrite; /* NULL: the kernel as it is */
    const void *rewrite_user;
    uint32_t rewrite_as;  /* identifies what *rewrite_user does: it differs where the result does */
    const uint32_t *spec; /* value of specialization constant i, for i < spec_count */
    uint32_t spec_count;
    const enum binding_kind *bindings; /* [i]: of binding i in set 0; NONE leaves a gap */
    uint32_t binding_count;
    uint32_t push_bytes;
    bool asks_statistics; /* for pipeline_get_statistics */
    const char *name;
};

struct pipeline_info {
    bool specialized;      /* constants were filled in before the driver saw the kernel */
    uint32_t instructions; /* in its functions; if specialized, in what is left of them */
    uint64_t bindings;     /* bit i: binding i is in its descriptor set layout */
};

/* Bindings that the kernel does not use once its constants are filled in get no descriptor. A
   kernel that cannot be specialized (which is logged), or any with WHIT_NO_SPECIALIZE=1 in the
   environment, keeps all bindings, and the driver fills its constants in. */
WHIT_CHECK whit_result pipeline_create(struct device *device, const struct pipeline_params *params,
                                       struct pipeline **out);
void pipeline_destroy(struct pipeline *pipeline);
void pipeline_get_info(const struct pipeline *pipeline, struct pipeline_info *info);
/* Reads the numbers that the driver keeps of a pipeline made with asks_statistics: subgroup size,
   registers and the like, under the driver's names. `statistics`: room for WHIT_STATISTICS_MAX;
   more are left out. *count is 0 where the driver has no VK_KHR_pipeline_executable_properties. */
WHIT_CHECK whit_result pipeline_get_statistics(const struct pipeline *pipeline,
                                               whit_statistic *statistics, uint32_t *count);
/* The info that a pipeline of these params would have, without making it. False when the kernel
   cannot be specialized. */
bool pipeline_count(const struct pipeline_params *params, struct pipeline_info *info);
/* Whether both kernels are the same code once their constants are filled in; false where one cannot
   be specialized. Takes some ms. */
bool pipeline_is_same(const struct pipeline_params *a, const struct pipeline_params *b);

/* buffers[i] goes to binding i. It must be NULL where the params have NONE, and may be anything
   where the kernel does not use the binding. The buffers are borrowed until the set is destroyed.
   The pipeline may not be destroyed before its sets. */
WHIT_CHECK whit_result binding_set_create(struct pipeline *pipeline, struct buffer *const *buffers,
                                          uint32_t count, struct binding_set **out);
void binding_set_destroy(struct binding_set *set);

#endif

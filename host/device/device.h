/* All of Vulkan: devices, buffers, compute pipelines, submission; windows in swapchain.h. No Vulkan
   type leaves this module, only handles as pointers, and nothing here knows what a triangle is.
   Vulkan 1.2; without a window compute only, and no extension required. Not thread-safe: one thread
   per device at a time. */
#ifndef DEVICE_DEVICE_H
#define DEVICE_DEVICE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/log.h"

struct device;
struct buffer;
struct pipeline;
struct binding_set;
struct commands;

enum device_kind {
    DEVICE_DISCRETE,
    DEVICE_INTEGRATED,
    DEVICE_VIRTUAL,
    DEVICE_CPU,
    DEVICE_OTHER,
};

struct device_info {
    uint32_t index; /* in the order Vulkan lists them; what `--device N` takes */
    char name[256];
    char driver[256]; /* name and version text */
    char api_version[32];
    enum device_kind kind;
    uint64_t memory_bytes;            /* of the largest device-local heap */
    uint64_t max_storage_range_bytes; /* of one storage buffer descriptor */
    uint64_t max_texel_elements;      /* of one texel buffer view */
    uint64_t max_allocation_bytes;
    uint32_t max_push_bytes, max_group_count_x, max_group_invocations;
    uint32_t subgroup_size;
    bool float64, int64, timestamps;
    /* What kernels may ask of floats of 32 bits: sums rounded to nearest; NaN, infinity and the
       sign of 0 kept; denormals kept. */
    bool asked_nearest, asked_special, asked_denormals;
    bool loop_limited; /* a driver that may end shaders after 65535 iterations (old lavapipe) */
    bool usable;       /* has what whit needs */
    char why_not[128]; /* when not usable */
};

/* All physical devices, usable or not; *infos is one block, free() it. No loader or driver at all
   is WHIT_ERROR_NO_DEVICE, logged with what to install. */
WHIT_CHECK whit_result device_list(const whit_log *log, struct device_info **infos,
                                   uint32_t *count);
const char *device_kind_name(enum device_kind kind);

/* A window that a device shows pictures in, for device_params. Who makes windows knows which
   instance extensions that takes, and makes the surface: `create` gets a VkInstance and the address
   of a VkSurfaceKHR, and returns a VkResult. The device destroys the surface. */
struct device_surface {
    const char *const *extensions;
    uint32_t extension_count; /* at most 8 */
    int (*create)(void *user, void *instance, void *surface);
    void *user;
};

struct device_params {
    const char *selector; /* NULL or "auto": discrete, else integrated, else virtual, else CPU; a
                             number: that index; else part of a name, any case */
    bool validation;      /* Khronos layer with GPU-assisted and synchronization checks; its
                             absence is an error. WHIT_VALIDATION=1 in the environment turns it on
                             for every device; WHIT_VALIDATION=sync without the GPU-assisted
                             checks, which make kernels slow to compile */
    const struct device_surface *surface; /* NULL: nothing is shown. Borrowed by device_create. A
                                             device that cannot present to it is not usable. */
};

/* A selector that no device answers is WHIT_ERROR_NO_DEVICE, logged with the devices there are.
   Compiled pipelines are kept from one run to the next (base/store.h), unless WHIT_NO_CACHE=1 is in
   the environment. */
WHIT_CHECK whit_result device_create(const whit_log *log, const struct device_params *params,
                                     struct device **out);
void device_destroy(struct device *device);
const struct device_info *device_get_info(const struct device *device);
/* How many threads may make pipelines of the device at once, as threads_for takes it: 0 is as many
   as there are cores. 1 while validation layers check, since those of Debian 12 crash where threads
   make devices at once and were not tried with pipelines; and while WHIT_FAULT counts calls. */
uint32_t device_compile_threads(const struct device *device);
/* Pipelines that the driver has been asked for so far, those of the device's own cache included;
   none that device_keep_pipelines gave again. From any thread. */
uint64_t device_pipelines_made(const struct device *device);
/* `what` and by which device and driver it was found, for store_read; free() it. NULL: no memory.
 */
char *device_kept_name(const struct device *device, const char *what);
/* Warnings and errors of the validation layers so far (each was logged). */
uint32_t device_validation_messages(const struct device *device);

/* What a buffer is used for, or-ed. */
enum buffer_use {
    BUFFER_STORAGE = 1,  /* storage buffer descriptor */
    BUFFER_TEXELS = 2,   /* uniform texel buffer view, four uint32 per element */
    BUFFER_INDIRECT = 4, /* arguments of a dispatch */
    BUFFER_HOST = 8, /* read or written by the host often: the host's memory, where kernels do not
                        reach the buffer, or reach that memory as fast as any */
    BUFFER_ZEROED = 16, /* contents start as zeros, else as they come */
};

/* Over the device's limits is WHIT_ERROR_DEVICE, logged with name, size
   and limit. `name` is copied and becomes the debug name. */
WHIT_CHECK whit_result buffer_create(struct device *device, uint64_t size_bytes, uint32_t uses,
                                     const char *name, struct buffer **out);
void buffer_destroy(struct buffer *buffer); /* NULL is fine; not while in flight */
/* What was asked for, rounded up to a multiple of 16, at least 16. */
uint64_t buffer_size(const struct buffer *buffer);
/* Through a staging buffer where the memory is not host-visible. Both wait until done. */
WHIT_CHECK whit_result buffer_write(struct buffer *buffer, uint64_t offset_bytes, const void *data,
                                    uint64_t size_bytes);
WHIT_CHECK whit_result buffer_read(struct buffer *buffer, uint64_t offset_bytes, void *data,
                                   uint64_t size_bytes);

enum binding_kind { BINDING_NONE, BINDING_STORAGE, BINDING_TEXELS };

enum { REWRITE_WHY_BYTES = 160 };

/* Makes another kernel of one, before its constants are filled in: *out is malloc()ed.
   WHIT_ERROR_INPUT: `why` says why not. Threads that make pipelines call it at once. */
typedef whit_result pipeline_rewrite(const void *user, const uint32_t *words, size_t word_count,
                                     uint32_t **out, size_t *out_words,
                                     char why[REWRITE_WHY_BYTES]);

struct pipeline_params {
    const uint32_t *spirv;
    size_t spirv_bytes;
    pipeline_rewrite *rewrite; /* NULL: the kernel as it is */
    const void *rewrite_user;
    uint32_t rewrite_as;  /* another number where *rewrite_user makes another kernel */
    const uint32_t *spec; /* value of specialization constant i, for i < spec_count */
    uint32_t spec_count;
    const enum binding_kind *bindings; /* of binding number i in set 0; NONE leaves a gap */
    uint32_t binding_count;
    uint32_t push_bytes;
    bool asks_statistics; /* for pipeline_get_statistics */
    const char *name;
};

struct pipeline_info {
    bool specialized;      /* constants were filled in before the driver saw the kernel */
    uint32_t instructions; /* of its functions; specialized: of what is left of them */
    uint64_t bindings;     /* bit i: binding i is in its descriptor set layout */
};

/* Bindings that the kernel does not use once its constants are filled in get no descriptor. A
   kernel that cannot be specialized, or WHIT_NO_SPECIALIZE=1 in the environment, keeps all of them,
   and the driver fills its constants in; the former is logged. */
WHIT_CHECK whit_result pipeline_create(struct device *device, const struct pipeline_params *params,
                                       struct pipeline **out);
/* From here on the device keeps pipelines, and gives who asks for one of the same params the one
   that it has. */
void device_keep_pipelines(struct device *device);
void pipeline_destroy(struct pipeline *pipeline);
void pipeline_get_info(const struct pipeline *pipeline, struct pipeline_info *info);
/* Reads the numbers that the driver keeps of a pipeline made with asks_statistics: subgroup size,
   registers and the like, under the driver's names. `statistics`: room for WHIT_STATISTICS_MAX;
   more are left out. *count is 0 where the driver has no VK_KHR_pipeline_executable_properties. */
WHIT_CHECK whit_result pipeline_get_statistics(const struct pipeline *pipeline,
                                               whit_statistic *statistics, uint32_t *count);
/* The same without a pipeline or a device. False when the kernel cannot be specialized. */
bool pipeline_count(const struct pipeline_params *params, struct pipeline_info *info);
/* Whether both are the same code once their constants are filled in; false where one cannot be
   specialized. Takes some ms. */
bool pipeline_is_same(const struct pipeline_params *a, const struct pipeline_params *b);

/* buffers[i] goes to binding i, NULL where the params have NONE, and at will where the kernel does
   not use it. The buffers are borrowed until
   the set is destroyed. The pipeline may not be destroyed before its sets. */
WHIT_CHECK whit_result binding_set_create(struct pipeline *pipeline, struct buffer *const *buffers,
                                          uint32_t count, struct binding_set **out);
void binding_set_destroy(struct binding_set *set);

/* A command buffer with its fence and timestamps: begin, record, submit, wait, and again. */
WHIT_CHECK whit_result commands_create(struct device *device, const char *name,
                                       struct commands **out);
void commands_destroy(struct commands *commands); /* waits first */
WHIT_CHECK whit_result commands_begin(struct commands *commands);
void commands_bind(struct commands *commands, struct pipeline *pipeline, struct binding_set *set);
void commands_push(struct commands *commands, const void *data, uint32_t size_bytes);
void commands_dispatch(struct commands *commands, uint32_t groups_x, uint32_t groups_y,
                       uint32_t groups_z);
void commands_dispatch_indirect(struct commands *commands, struct buffer *buffer,
                                uint64_t offset_bytes);
/* Everything before is visible to everything after: shader, transfer, indirect, host. */
void commands_barrier(struct commands *commands);
void commands_fill(struct commands *commands, struct buffer *buffer, uint64_t offset_bytes,
                   uint64_t size_bytes, uint32_t word);
void commands_copy(struct commands *commands, struct buffer *from, uint64_t from_offset_bytes,
                   struct buffer *to, uint64_t to_offset_bytes, uint64_t size_bytes);
/* A labelled stretch whose time is measured; at most COMMANDS_SPANS a recording, not nested. */
enum { COMMANDS_SPANS = 256 };
void commands_span_begin(struct commands *commands, const char *label);
void commands_span_end(struct commands *commands);
/* A recording error (out of memory) surfaces here. */
WHIT_CHECK whit_result commands_submit(struct commands *commands);
/* Waits up to `timeout_ms` (< 0: for ever). WHIT_ERROR_TIME_LIMIT leaves it in flight. */
WHIT_CHECK whit_result commands_wait(struct commands *commands, double timeout_ms);
/* Device time of span i of the last finished submission; < 0 without timestamps. */
double commands_span_ms(const struct commands *commands, uint32_t span);
uint32_t commands_span_count(const struct commands *commands);

#endif

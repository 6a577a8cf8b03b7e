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
#include "whit/whit_device.h"

struct device;
struct buffer;
struct pipeline;
struct binding_set;
struct commands;

/* Limits of a device that only makers of kernels and buffers need; the others are public. */
struct device_limits {
    uint64_t max_texel_elements; /* of one texel buffer view */
    uint64_t max_allocation_bytes;
    uint32_t max_group_count_x;
    /* What kernels may ask of floats of 32 bits: sums rounded to nearest; NaN, infinity and the
       sign of 0 kept; denormals kept. */
    bool asked_nearest, asked_special, asked_denormals;
    bool loop_limited; /* a driver that may end shaders after 65535 iterations (old lavapipe) */
};

/* All physical devices, usable or not; *infos is one block, free() it. No loader or driver at all
   is WHIT_ERROR_NO_DEVICE, logged with what to install. */
WHIT_CHECK whit_result device_list(const whit_log *log, whit_device_info **infos, uint32_t *count);

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
    const char *selector; /* as of whit_device_params */
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
const whit_device_info *device_get_info(const struct device *device);
const struct device_limits *device_get_limits(const struct device *device);
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

/* From here on the device keeps pipelines, and gives who asks for one of the same params the one
   that it has. */
void device_keep_pipelines(struct device *device);

#endif

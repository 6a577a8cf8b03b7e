/* All of Vulkan: devices, buffers, compute pipelines, submission; windows in swapchain.h. No Vulkan
   type leaves this module, only handles as pointers, and nothing here knows what a triangle is.
   Vulkan 1.2; without a window compute only, and no extension required. Threads may share a device
   that shows nothing; each of its buffers, pipelines and commands is used by one at a time. */
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

/* Limits that only code making kernels and buffers needs; the others are in whit_device_info. */
struct device_limits {
    uint64_t max_texel_elements; /* of one texel buffer view */
    uint64_t max_allocation_bytes;
    /* Whether kernels may request these of 32-bit floats (float controls): rounding to nearest;
       NaN, infinity and the sign of 0 kept; denormals kept. */
    bool asked_nearest, asked_special, asked_denormals;
    bool loop_limited; /* the driver may end shaders after 65535 loop iterations (old lavapipe) */
};

/* Lists all physical devices, usable or not; *infos is one block, free() it. Without any loader or
   driver: WHIT_ERROR_NO_DEVICE, logged with what to install. */
WHIT_CHECK whit_result device_list(const whit_log *log, whit_device_info **infos, uint32_t *count);

/* A window that a device shows pictures in. The maker of the window names the
   instance extensions that it needs, and makes the surface: `create` gets a VkInstance and the
   address of a VkSurfaceKHR, and returns a VkResult. The device destroys the surface. */
struct device_surface {
    const char *const *extensions;
    uint32_t extension_count; /* at most 8 */
    int (*create)(void *user, void *instance, void *surface);
    void *user;
};

/* `params` may be NULL. Validation is by the Khronos layer with GPU-assisted and synchronization
   checks. WHIT_VALIDATION=1 in the environment turns it on for every device; WHIT_VALIDATION=sync
   without the GPU-assisted checks, which make kernels slow to compile. `surface` is borrowed during
   the call (NULL: nothing is shown); a device that cannot present to it is not usable. A selector
   that matches no device gives WHIT_ERROR_NO_DEVICE, logged with the devices there are. Compiled
   pipelines are kept from one run to the next (base/store.h), unless WHIT_NO_CACHE=1 is in the
   environment. */
WHIT_CHECK whit_result device_create(const whit_log *log, const whit_device_params *params,
                                     const struct device_surface *surface, struct device **out);
void device_destroy(struct device *device);
const whit_device_info *device_get_info(const struct device *device);
const struct device_limits *device_get_limits(const struct device *device);
/* How many threads may make pipelines of the device at once, in the form that threads_for takes: 0
   for as many as there are cores. 1 while WHIT_FAULT counts calls, and under validation layers:
   those of Debian 12 crash when threads create devices at once, and pipelines were not tried. */
uint32_t device_compile_threads(const struct device *device);
/* How many pipelines the driver was asked for so far. Those that it found in its own cache count,
   those that device_keep_pipelines made unnecessary do not. From any thread. */
uint64_t device_pipelines_made(const struct device *device);
/* The name under which store_read finds `what` of this device and driver; free() it. NULL: no
   memory. */
char *device_kept_name(const struct device *device, const char *what);
/* Number of warnings and errors of the validation layers so far (each was logged). */
uint32_t device_validation_messages(const struct device *device);

/* From here on the device keeps its pipelines, and pipeline_create returns a kept one where the
   params are the same. */
void device_keep_pipelines(struct device *device);

#endif

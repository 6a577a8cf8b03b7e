/* Pipelines that a device keeps. */
#ifndef DEVICE_KEPT_H
#define DEVICE_KEPT_H

#include "device/vulkan.h"

/* A kept pipeline whose code, after specialization, is `words`, with one user more; NULL: none is
   kept. Remembers the code's key in `made`. */
WHIT_CHECK struct pipeline *kept_take_code(struct pipeline *made,
                                           const struct pipeline_params *params,
                                           const uint32_t *words, size_t word_count);
/* Finds a kept pipeline of the same params, with one user more; false: none is kept. `specializes`:
   whether constants are filled in before the driver sees the kernel. */
bool kept_take(struct device *device, const struct pipeline_params *params, bool specializes,
               struct pipeline **out);
/* Keeps a pipeline that was just made, if the device keeps pipelines. */
void kept_add(struct pipeline *pipeline, const struct pipeline_params *params, bool specializes);
/* Takes one user from a pipeline that the device keeps; false: it is not kept. */
bool kept_give_back(struct pipeline *pipeline);
void kept_finish(struct device *device);

#endif

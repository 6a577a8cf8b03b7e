/* Pipelines that a device keeps. */
#ifndef DEVICE_KEPT_H
#define DEVICE_KEPT_H

#include "device/vulkan.h"

/* One whose params make the same code of the kernel as those of `made`, with one user more;
   NULL: the device keeps none. Remembers the code's key in `made`. */
WHIT_CHECK struct pipeline *kept_take_code(struct pipeline *made,
                                           const struct pipeline_params *params,
                                           const uint32_t *words, size_t word_count);
/* A pipeline of the same params, with one user more; false: the device keeps none.
   `specializes`: whether constants are filled in before the driver sees the kernel. */
bool kept_take(struct device *device, const struct pipeline_params *params, bool specializes,
               struct pipeline **out);
/* Keeps one that was just made, where the device keeps any. */
void kept_add(struct pipeline *pipeline, const struct pipeline_params *params, bool specializes);
/* Whether the device keeps it, which has one user less. */
bool kept_give_back(struct pipeline *pipeline);
void kept_finish(struct device *device);

#endif

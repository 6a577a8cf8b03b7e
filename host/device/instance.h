/* Vulkan instances, and the choice of a physical device. */
#ifndef DEVICE_INSTANCE_H
#define DEVICE_INSTANCE_H

#include "device/vulkan.h"

/* Also sets `surface`, if one is asked for. instance_create and instance_destroy need no more of
   `device` than log, fault and validation; all else may be zero. */
whit_result instance_create(struct device *device);
void instance_destroy(struct device *device);
/* Sets physical, properties, memory and info. */
whit_result instance_select(struct device *device, const char *selector);
/* The family that the device's one queue comes from; false when none computes. With a `surface`,
   the family also draws and presents to it. */
bool instance_queue_family(VkPhysicalDevice physical, VkSurfaceKHR surface, uint32_t *family,
                           uint32_t *timestamp_bits);

#endif

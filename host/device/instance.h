/* Instances, and which device of theirs is taken. */
#ifndef DEVICE_INSTANCE_H
#define DEVICE_INSTANCE_H

#include "device/vulkan.h"

/* Both work on a zeroed struct device that has its log, fault and validation. */
whit_result instance_create(struct device *device);
/* After instance_create, and before instance_select: sets surface, where one is asked for. */
whit_result instance_make_surface(struct device *device);
void instance_destroy(struct device *device);
/* Sets physical, properties, memory and info. */
whit_result instance_select(struct device *device, const char *selector);
/* The family that the device's one queue comes from; false when none computes.
   `surface`: not null: the family also draws, and presents to it. */
bool instance_queue_family(VkPhysicalDevice physical, VkSurfaceKHR surface, uint32_t *family,
                           uint32_t *timestamp_bits);

#endif

/* The pipeline cache and its file. */
#ifndef DEVICE_CACHE_H
#define DEVICE_CACHE_H

#include "device/vulkan.h"

whit_result cache_open(struct device *device);
void cache_close(struct device *device); /* saves the cache, then destroys it */

#endif

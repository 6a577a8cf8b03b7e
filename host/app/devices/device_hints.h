/* Why a GPU that the machine has may be missing from Vulkan's list. */
#ifndef APP_DEVICES_DEVICE_HINTS_H
#define APP_DEVICES_DEVICE_HINTS_H

#include "whit/whit.h"

enum { DEVICE_HINTS_MAX = 4, DEVICE_HINT_BYTES = 320 };

struct device_hints {
    uint32_t count;
    char list[DEVICE_HINTS_MAX][DEVICE_HINT_BYTES]; /* one sentence each */
};

/* `root`: "" , or a folder in place of `/`, for tests. `asked`: what NVIDIA_DRIVER_CAPABILITIES
   says; NULL: it is not set. */
void device_hints_find(const char *root, const char *asked, const whit_device_info *infos,
                       uint32_t count, struct device_hints *hints);

#endif

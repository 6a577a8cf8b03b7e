/* Command buffers for sources of device/ that make Vulkan calls of their own. */
#ifndef DEVICE_COMMANDS_PRIVATE_H
#define DEVICE_COMMANDS_PRIVATE_H

#include "device/commands.h"
#include "device/vulkan.h"

/* For commands that commands.h has no function for. */
VkCommandBuffer commands_vk(const struct commands *commands);
/* As commands_submit. The device waits for `wait` before it begins, and signals `signal` when it is
   done; either may be VK_NULL_HANDLE. */
WHIT_CHECK whit_result commands_submit_between(struct commands *commands, VkSemaphore wait,
                                               VkSemaphore signal);

#endif

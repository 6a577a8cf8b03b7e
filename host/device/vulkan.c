/* Checks Vulkan calls, and makes them fail for tests. */
#include "device/vulkan.h"

#include <stdlib.h>
#include <string.h>

#include "base/path.h"
#include "whit/whit_program.h"

static const char *result_text(VkResult vk)
{
#define NAME(code)                                                                                 \
    case code:                                                                                     \
        return #code
    switch (vk) {
        NAME(VK_NOT_READY);
        NAME(VK_TIMEOUT);
        NAME(VK_INCOMPLETE);
        NAME(VK_ERROR_OUT_OF_HOST_MEMORY);
        NAME(VK_ERROR_OUT_OF_DEVICE_MEMORY);
        NAME(VK_ERROR_INITIALIZATION_FAILED);
        NAME(VK_ERROR_DEVICE_LOST);
        NAME(VK_ERROR_MEMORY_MAP_FAILED);
        NAME(VK_ERROR_LAYER_NOT_PRESENT);
        NAME(VK_ERROR_EXTENSION_NOT_PRESENT);
        NAME(VK_ERROR_FEATURE_NOT_PRESENT);
        NAME(VK_ERROR_INCOMPATIBLE_DRIVER);
        NAME(VK_ERROR_TOO_MANY_OBJECTS);
        NAME(VK_ERROR_FORMAT_NOT_SUPPORTED);
        NAME(VK_ERROR_FRAGMENTED_POOL);
        NAME(VK_ERROR_OUT_OF_POOL_MEMORY);
        NAME(VK_ERROR_FRAGMENTATION);
        NAME(VK_ERROR_INVALID_SHADER_NV);
    default:
        return "VK_ERROR_UNKNOWN";
    }
#undef NAME
}

static whit_result result_map(VkResult vk)
{
    switch (vk) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
    case VK_ERROR_OUT_OF_POOL_MEMORY:
    case VK_ERROR_MEMORY_MAP_FAILED:
        return WHIT_ERROR_MEMORY;
    case VK_ERROR_INCOMPATIBLE_DRIVER:
        return WHIT_ERROR_NO_DEVICE;
    default:
        return WHIT_ERROR_DEVICE;
    }
}

whit_result device_check(struct device *device, VkResult vk, const char *expression,
                         const char *file, int line)
{
    if (vk == VK_TIMEOUT)
        return WHIT_ERROR_TIME_LIMIT;
    if (vk >= 0)
        return WHIT_OK;
    /* Several threads may find that the device is lost; only the first one logs it. */
    bool told = vk == VK_ERROR_DEVICE_LOST ? atomic_exchange(&device->lost, true) : device->lost;
    if (told)
        return WHIT_ERROR_DEVICE;
    const char *lacks = whit_shortage(DRIVER_ROOM_BYTES);
    log_error(&device->log, "%s (%d) from %s at %s:%d%s%s", result_text(vk), (int)vk, expression,
              path_name(file), line, lacks ? ": " : "", lacks ? lacks : "");
    return lacks ? WHIT_ERROR_MEMORY : result_map(vk);
}

bool environment_on(const char *name)
{
    const char *value = getenv(name);
    return value && *value && strcmp(value, "0") != 0;
}

void device_read_fault(struct device *device)
{
    const char *text = getenv("WHIT_FAULT");
    const char *colon = text ? strchr(text, ':') : NULL;
    char *rest = NULL;
    if (!colon || (size_t)(colon - text) >= sizeof device->fault.call)
        return;
    memcpy(device->fault.call, text, (size_t)(colon - text));
    device->fault.at = (uint32_t)strtoul(colon + 1, &rest, 10);
    device->fault.result = *rest == ':' ? (int32_t)strtol(rest + 1, NULL, 10) : 0;
}

static bool fails(struct device *device, const char *expression)
{
    struct fault *fault = &device->fault;
    size_t length = strlen(fault->call);
    bool named = strncmp(expression, fault->call, length) == 0 &&
                 (expression[length] == '(' || expression[length] == '\0');
    if (length == 0 || (!named && strcmp(fault->call, "*") != 0))
        return false;
    return ++fault->seen == fault->at;
}

bool device_may_call(struct device *device, const char *expression, VkResult *vk)
{
    bool loses = strncmp(expression, "vkQueueSubmit", 13) == 0 ||
                 strncmp(expression, "vkWaitForFences", 15) == 0;
    if (device->lost) {
        *vk = VK_ERROR_DEVICE_LOST;
        return false;
    }
    if (fails(device, expression)) {
        int32_t result = device->fault.result;
        if (result != 0) {
            *vk = (VkResult)result;
            return result > 0;
        }
        *vk = loses ? VK_ERROR_DEVICE_LOST : VK_ERROR_OUT_OF_DEVICE_MEMORY;
        return false;
    }
    return true;
}

void device_name_object(struct device *device, VkObjectType type, uint64_t handle, const char *name)
{
    if (!device->set_object_name)
        return;
    VkDebugUtilsObjectNameInfoEXT info = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
        .objectType = type,
        .objectHandle = handle,
        .pObjectName = name,
    };
    /* A name that cannot be kept is only missing from a debugger. */
    (void)LAYERS_BESIDE(device->set_object_name(device->vk, &info));
}

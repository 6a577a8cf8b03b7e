#include "device/vulkan.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/child.h"
#include "base/file.h"
#include "base/threads.h"

const char *device_kind_name(enum device_kind kind)
{
    switch (kind) {
    case DEVICE_DISCRETE:
        return "discrete GPU";
    case DEVICE_INTEGRATED:
        return "integrated GPU";
    case DEVICE_VIRTUAL:
        return "virtual GPU";
    case DEVICE_CPU:
        return "CPU";
    case DEVICE_OTHER:
        break;
    }
    return "other";
}

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
    /* Of threads that make kernels at the same time each sees the loss, and the first tells of it.
     */
    bool told = vk == VK_ERROR_DEVICE_LOST ? atomic_exchange(&device->lost, true) : device->lost;
    if (told)
        return WHIT_ERROR_DEVICE;
    const char *lacks = whit_shortage(DRIVER_ROOM_BYTES);
    log_error(&device->log, "%s (%d) from %s at %s:%d%s%s", result_text(vk), (int)vk, expression,
              path_name(file), line, lacks ? ": " : "", lacks ? lacks : "");
    return lacks ? WHIT_ERROR_MEMORY : result_map(vk);
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

uint32_t device_compile_threads(const struct device *device)
{
    return device->validation || device->fault.call[0] ? 1 : 0;
}

bool device_fault(struct device *device, const char *expression)
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
    if (device_fault(device, expression)) {
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

static bool environment_on(const char *name)
{
    const char *value = getenv(name);
    return value && *value && strcmp(value, "0") != 0;
}

static bool has_extension(struct device *device, const char *name)
{
    uint32_t count = 0;
    if (vkEnumerateDeviceExtensionProperties(device->physical, NULL, &count, NULL) < 0)
        return false;
    VkExtensionProperties *extensions = array_alloc_zeroed(count, sizeof *extensions);
    bool found = false;
    if (extensions &&
        vkEnumerateDeviceExtensionProperties(device->physical, NULL, &count, extensions) >= 0)
        for (uint32_t i = 0; i < count && !found; ++i)
            found = strcmp(extensions[i].extensionName, name) == 0;
    free(extensions);
    return found;
}

/* lavapipe starts a thread a core, and a few more, and waits for ever for one that did not start.
 */
static whit_result check_room(const struct device *device)
{
    enum { OTHER_THREADS = 4 };
    if (device->info.kind != DEVICE_CPU || threads_have_room(threads_available() + OTHER_THREADS))
        return WHIT_OK;
    log_error(&device->log, "%s: out of memory for its threads", device->info.name);
    return WHIT_ERROR_MEMORY;
}

static whit_result logical_create(struct device *device)
{
    whit_result result = WHIT_OK;
    uint32_t timestamp_bits = 0;
    if (!instance_queue_family(device->physical, device->surface, &device->queue_family,
                               &timestamp_bits))
        return WHIT_ERROR_NO_DEVICE; /* instance_select refuses such a device with its reason */
    if (timestamp_bits > 0 && device->properties.limits.timestampPeriod > 0.0f)
        device->timestamp_mask =
            timestamp_bits >= 64 ? UINT64_MAX : (UINT64_C(1) << timestamp_bits) - 1;

    static const char portability[] = "VK_KHR_portability_subset";
    static const char executables[] = VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME;
    const char *extensions[3];
    uint32_t extension_count = 0;
    if (has_extension(device, portability))
        extensions[extension_count++] = portability;
    bool tells = has_extension(device, executables);
    if (tells)
        extensions[extension_count++] = executables;
    if (device->surface)
        extensions[extension_count++] = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    float priority = 1.0f;
    VkDeviceQueueCreateInfo queue = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
        .queueFamilyIndex = device->queue_family,
        .queueCount = 1,
        .pQueuePriorities = &priority,
    };
    VkPhysicalDeviceFeatures features = {
        .robustBufferAccess = device->validation,
        .shaderFloat64 = device->info.float64,
        .shaderInt64 = device->info.int64,
    };
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR telling = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR,
        .pipelineExecutableInfo = VK_TRUE,
    };
    VkDeviceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
        .pNext = tells ? &telling : NULL,
        .queueCreateInfoCount = 1,
        .pQueueCreateInfos = &queue,
        .enabledExtensionCount = extension_count,
        .ppEnabledExtensionNames = extensions,
        .pEnabledFeatures = &features,
    };
    VK_TRY(device, vkCreateDevice(device->physical, &info, NULL, &device->vk));
    vkGetDeviceQueue(device->vk, device->queue_family, 0, &device->queue);
    if (tells) {
        device->get_executables = (PFN_vkGetPipelineExecutablePropertiesKHR)vkGetDeviceProcAddr(
            device->vk, "vkGetPipelineExecutablePropertiesKHR");
        device->get_executable_statistics =
            (PFN_vkGetPipelineExecutableStatisticsKHR)vkGetDeviceProcAddr(
                device->vk, "vkGetPipelineExecutableStatisticsKHR");
    }
    if (device->debug_utils) {
        device->set_object_name = (PFN_vkSetDebugUtilsObjectNameEXT)vkGetDeviceProcAddr(
            device->vk, "vkSetDebugUtilsObjectNameEXT");
        device->begin_label = (PFN_vkCmdBeginDebugUtilsLabelEXT)vkGetDeviceProcAddr(
            device->vk, "vkCmdBeginDebugUtilsLabelEXT");
        device->end_label = (PFN_vkCmdEndDebugUtilsLabelEXT)vkGetDeviceProcAddr(
            device->vk, "vkCmdEndDebugUtilsLabelEXT");
    }
    device_name_object(device, VK_OBJECT_TYPE_DEVICE, (uint64_t)device->vk, "whit");
    device_name_object(device, VK_OBJECT_TYPE_QUEUE, (uint64_t)device->queue, "compute");
fail:
    return result;
}

whit_result device_create(const whit_log *log, const struct device_params *params,
                          struct device **out)
{
    *out = NULL;
    struct device *device = array_alloc_zeroed(1, sizeof *device);
    if (!device) {
        log_error(log, "out of memory for a device");
        return WHIT_ERROR_MEMORY;
    }
    pthread_mutex_init(&device->kept_lock, NULL);
    if (log)
        device->log = log_or_silence(log);
    const char *validation = getenv("WHIT_VALIDATION");
    bool asked = params && params->validation;
    device->validation = asked || environment_on("WHIT_VALIDATION");
    device->validation_of_shaders =
        device->validation && (asked || strcmp(validation, "sync") != 0);
    if (device->validation)
        layers_expect();
    device->staged = environment_on("WHIT_STAGING");
    device->poisons = environment_on("WHIT_POISON");
    device_read_fault(device);

    device->surface_source = params ? params->surface : NULL;

    /* Loading drivers takes locks that a child forked meanwhile would find held for ever. */
    child_hold_forks();
    whit_result result = instance_create(device);
    if (result == WHIT_OK)
        result = instance_make_surface(device);
    device->surface_source = NULL;
    if (result == WHIT_OK)
        result = instance_select(device, params ? params->selector : NULL);
    if (result == WHIT_OK)
        result = check_room(device);
    if (result == WHIT_OK)
        result = logical_create(device);
    if (result == WHIT_OK)
        result = cache_open(device);
    child_release_forks();
    if (result != WHIT_OK) {
        device_destroy(device);
        return result;
    }
    log_debug(&device->log, "device %u: %s, %s, Vulkan %s", device->info.index, device->info.name,
              device->info.driver, device->info.api_version);
    *out = device;
    return WHIT_OK;
}

void device_destroy(struct device *device)
{
    if (!device)
        return;
    child_hold_forks(); /* unloading takes the locks that loading takes */
    if (device->vk) {
        commands_destroy(device->transfer);
        buffer_destroy(device->staging);
        kept_finish(device);
        cache_close(device);
        vkDestroyDevice(device->vk, NULL);
    }
    instance_destroy(device);
    child_release_forks();
    pthread_mutex_destroy(&device->kept_lock);
    free(device);
}

const struct device_info *device_get_info(const struct device *device)
{
    return &device->info;
}

uint32_t device_validation_messages(const struct device *device)
{
    return atomic_load(&device->validation_messages);
}

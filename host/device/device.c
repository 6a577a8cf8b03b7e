#include "device/device.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/child.h"
#include "base/threads.h"
#include "device/buffer.h"
#include "device/cache.h"
#include "device/commands.h"
#include "device/instance.h"
#include "device/kept.h"

uint32_t device_compile_threads(const struct device *device)
{
    return device->validation || device->fault.call[0] ? 1 : 0;
}

static bool has_extension(struct device *device, const char *name)
{
    uint32_t count = 0;
    if (LAYERS_BESIDE(vkEnumerateDeviceExtensionProperties(device->physical, NULL, &count, NULL)) <
        0)
        return false;
    VkExtensionProperties *extensions = array_alloc_zeroed(count, sizeof *extensions);
    bool found = false;
    if (extensions && LAYERS_BESIDE(vkEnumerateDeviceExtensionProperties(device->physical, NULL,
                                                                         &count, extensions)) >= 0)
        for (uint32_t i = 0; i < count && !found; ++i)
            found = strcmp(extensions[i].extensionName, name) == 0;
    free(extensions);
    return found;
}

/* lavapipe starts one thread per core and a few more, and waits for ever if one of them cannot
   start. */
static whit_result check_room(const struct device *device)
{
    enum { OTHER_THREADS = 4 };
    if (device->info.kind != WHIT_DEVICE_CPU ||
        threads_have_room(threads_available() + OTHER_THREADS))
        return WHIT_OK;
    return log_failure(&device->log, WHIT_ERROR_MEMORY, "%s: out of memory for its threads",
                       device->info.name);
}

/* Finds the functions of extensions; `tells`: the device tells figures of its pipelines. */
static void find_functions(struct device *device, bool tells)
{
    if (tells) {
        device->get_executables = (PFN_vkGetPipelineExecutablePropertiesKHR)LAYERS_BESIDE(
            vkGetDeviceProcAddr(device->vk, "vkGetPipelineExecutablePropertiesKHR"));
        device->get_executable_statistics = (PFN_vkGetPipelineExecutableStatisticsKHR)LAYERS_BESIDE(
            vkGetDeviceProcAddr(device->vk, "vkGetPipelineExecutableStatisticsKHR"));
    }
    /* The loader (1.3.239) looks the device of a named object up in its list of instances, to which
       other threads may add theirs, without a lock. Validation locks around both (layers.h). */
    if (device->debug_utils && device->validation)
        device->set_object_name = (PFN_vkSetDebugUtilsObjectNameEXT)LAYERS_BESIDE(
            vkGetDeviceProcAddr(device->vk, "vkSetDebugUtilsObjectNameEXT"));
    if (device->debug_utils) {
        device->begin_label = (PFN_vkCmdBeginDebugUtilsLabelEXT)LAYERS_BESIDE(
            vkGetDeviceProcAddr(device->vk, "vkCmdBeginDebugUtilsLabelEXT"));
        device->end_label = (PFN_vkCmdEndDebugUtilsLabelEXT)LAYERS_BESIDE(
            vkGetDeviceProcAddr(device->vk, "vkCmdEndDebugUtilsLabelEXT"));
    }
}

static whit_result logical_create(struct device *device)
{
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
    VkResult vk = VK_SUCCESS;
    if (device_may_call(device, "vkCreateDevice", &vk))
        vk = LAYERS_ALONE(vkCreateDevice(device->physical, &info, NULL, &device->vk));
    whit_result result = device_check(device, vk, "vkCreateDevice", __FILE__, __LINE__);
    if (result != WHIT_OK)
        return result;
    LAYERS_BESIDE(vkGetDeviceQueue(device->vk, device->queue_family, 0, &device->queue));
    find_functions(device, tells);
    device_name_object(device, VK_OBJECT_TYPE_DEVICE, (uint64_t)device->vk, "whit");
    device_name_object(device, VK_OBJECT_TYPE_QUEUE, (uint64_t)device->queue, "compute");
    return WHIT_OK;
}

/* Submissions that look for the driver's threads: until they run, they may lack names of their own.
 */
enum { SPREADS = 4 };

whit_result device_create(const whit_log *log, const whit_device_params *params,
                          const struct device_surface *surface, struct device **out)
{
    *out = NULL;
    struct device *device = array_alloc_zeroed(1, sizeof *device);
    if (!device)
        return log_failure(log, WHIT_ERROR_MEMORY, "out of memory for a device");
    pthread_mutex_init(&device->kept_lock, NULL);
    pthread_mutex_init(&device->queue_lock, NULL);
    pthread_mutex_init(&device->transfer_lock, NULL);
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

    device->surface_source = surface;

    /* Loading drivers takes locks that a child forked meanwhile would find held for ever. */
    child_hold_forks();
    char before[CORES_NAME_BYTES];
    cores_name_threads(device->threads, before);
    whit_result result = instance_create(device);
    device->surface_source = NULL;
    if (result == WHIT_OK)
        result = instance_select(device, params ? params->selector : NULL);
    if (result == WHIT_OK)
        result = check_room(device);
    if (result == WHIT_OK)
        result = logical_create(device);
    cores_end_names(before);
    if (device->info.kind == WHIT_DEVICE_CPU)
        device->spreads_left = SPREADS;
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
        LAYERS_ALONE(vkDestroyDevice(device->vk, NULL));
    }
    instance_destroy(device);
    child_release_forks();
    pthread_mutex_destroy(&device->kept_lock);
    pthread_mutex_destroy(&device->queue_lock);
    pthread_mutex_destroy(&device->transfer_lock);
    free(device);
}

const whit_device_info *device_get_info(const struct device *device)
{
    return &device->info;
}

const struct device_limits *device_get_limits(const struct device *device)
{
    return &device->limits;
}

uint32_t device_validation_messages(const struct device *device)
{
    return atomic_load(&device->validation_messages);
}

void device_keep_pipelines(struct device *device)
{
    device->keeps = true;
}

uint64_t device_pipelines_made(const struct device *device)
{
    return device->pipelines_made;
}

/* The name contains the subgroup size, since kept pipelines may depend on it. */
char *device_kept_name(const struct device *device, const char *what)
{
    char uuid[2 * VK_UUID_SIZE + 1];
    for (size_t i = 0; i < VK_UUID_SIZE; ++i)
        snprintf(uuid + 2 * i, 3, "%02x", device->properties.pipelineCacheUUID[i]);
    return string_format("%s-%04x-%04x-%s-%u%s", what, device->properties.vendorID,
                         device->properties.deviceID, uuid, device->info.subgroup_size,
                         device->validation ? "-validation" : "");
}

#include "device/instance.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/child.h"
#include "base/text.h"
#include "whit/whit_program.h"

static const char *const validation_layer = "VK_LAYER_KHRONOS_validation";
static const char *const install_driver =
    "install one (Debian: mesa-vulkan-drivers, which also runs without a GPU)";

static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                 VkDebugUtilsMessageTypeFlagsEXT types,
                                                 const VkDebugUtilsMessengerCallbackDataEXT *data,
                                                 void *user)
{
    struct device *device = user;
    if (!(types & VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT) || device->abandoned)
        return VK_FALSE;
    char text[1900];
    snprintf(text, sizeof text, "validation: %s", data->pMessage ? data->pMessage : "");
    for (char *at = text; *at; ++at)
        if (*at == '\n' || *at == '\r')
            *at = ' ';
    atomic_fetch_add(&device->validation_messages, 1);
    if (severity >= VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT)
        log_error(&device->log, "%s", text);
    else
        log_warning(&device->log, "%s", text);
    return VK_FALSE;
}

static VkDebugUtilsMessengerCreateInfoEXT messenger_info(struct device *device)
{
    return (VkDebugUtilsMessengerCreateInfoEXT){
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
        .pfnUserCallback = on_message,
        .pUserData = device,
    };
}

/* Logs that `what` was not found. Where memory or file descriptors are short, that is the reason
   given, and not `why`: a driver or layer that is installed then fails to load too. */
static whit_result refuse(struct device *device, const char *what, const char *why,
                          whit_result result)
{
    const char *lacks = whit_shortage(DRIVER_ROOM_BYTES);
    log_error(&device->log, "%s: %s", what, lacks ? lacks : why);
    return lacks ? WHIT_ERROR_MEMORY : result;
}

/* The Vulkan loader says that memory ran out where a driver's manifest is no JSON, and says so
   again, while a single allocation that failed succeeds the second time. */
static bool has_bad_manifest(VkResult vk, const char *layer)
{
    uint32_t count;
    return vk == VK_ERROR_OUT_OF_HOST_MEMORY && !layer &&
           vkEnumerateInstanceExtensionProperties(NULL, &count, NULL) == vk;
}

static whit_result refuse_manifest(struct device *device)
{
    static const char *const names[] = {"VK_ADD_DRIVER_FILES", "VK_ICD_FILENAMES",
                                        "VK_DRIVER_FILES"};
    const char *named = NULL;
    char why[160];
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i)
        named = getenv(names[i]) ? names[i] : named;
    snprintf(why, sizeof why, "the Vulkan loader cannot read a driver's manifest%s%s%s",
             named ? ", which " : "", named ? named : "", named ? " names" : "");
    return refuse(device, "no usable device", why, WHIT_ERROR_NO_DEVICE);
}

/* Finds which of `names` the loader (layer NULL) or a layer offers: bit i of *found: names[i]. */
static whit_result find_extensions(struct device *device, const char *layer,
                                   const char *const *names, uint32_t name_count, uint32_t *found)
{
    whit_result result = WHIT_OK;
    VkExtensionProperties *list = NULL;
    uint32_t count = 0;
    *found = 0;
    VkResult vk = VK_SUCCESS;
    if (device_may_call(device, "vkEnumerateInstanceExtensionProperties", &vk))
        vk = vkEnumerateInstanceExtensionProperties(layer, &count, NULL);
    if (has_bad_manifest(vk, layer))
        return refuse_manifest(device);
    result = device_check(device, vk, "vkEnumerateInstanceExtensionProperties", __FILE__, __LINE__);
    if (result != WHIT_OK)
        return result;
    list = array_alloc_zeroed(count, sizeof *list);
    if (!list)
        return log_failure(&device->log, WHIT_ERROR_MEMORY,
                           "out of memory for %u Vulkan extensions", count);
    VK_TRY(device, vkEnumerateInstanceExtensionProperties(layer, &count, list));
    for (uint32_t i = 0; i < count; ++i)
        for (uint32_t j = 0; j < name_count; ++j)
            if (strcmp(list[i].extensionName, names[j]) == 0)
                *found |= 1u << j;
fail:
    free(list);
    return result;
}

static whit_result find_validation(struct device *device)
{
    whit_result result = WHIT_OK;
    VkLayerProperties *list = NULL;
    uint32_t count = 0;
    bool found = false;
    VK_TRY(device, vkEnumerateInstanceLayerProperties(&count, NULL));
    list = array_alloc_zeroed(count, sizeof *list);
    if (!list)
        return log_failure(&device->log, WHIT_ERROR_MEMORY, "out of memory for %u Vulkan layers",
                           count);
    VK_TRY(device, vkEnumerateInstanceLayerProperties(&count, list));
    for (uint32_t i = 0; i < count; ++i)
        found |= strcmp(list[i].layerName, validation_layer) == 0;
    if (!found)
        result = refuse(device, "validation was asked for, but its layer cannot be had",
                        "install it (Debian: vulkan-validationlayers)", WHIT_ERROR_DEVICE);
fail:
    free(list);
    return result;
}

static whit_result check_loader(struct device *device)
{
    whit_result result = WHIT_OK;
    uint32_t version = 0;
    VK_TRY(device, vkEnumerateInstanceVersion(&version));
    if (version < VK_API_VERSION_1_2)
        result = log_failure(&device->log, WHIT_ERROR_NO_DEVICE,
                             "the Vulkan loader knows version %u.%u only, whit needs 1.2",
                             VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version));
fail:
    return result;
}

static whit_result make_instance(struct device *device, uint32_t extensions,
                                 const char *const *names, uint32_t name_count,
                                 bool validation_features)
{
    const struct device_surface *surface = device->surface_source;
    const char *enabled[16];
    uint32_t enabled_count = 0;
    for (uint32_t i = 0; surface && i < surface->extension_count && i < 8; ++i)
        enabled[enabled_count++] = surface->extensions[i];
    for (uint32_t i = 0; i < name_count; ++i)
        if (extensions >> i & 1)
            enabled[enabled_count++] = names[i];
    if (validation_features)
        enabled[enabled_count++] = VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME;

    const VkValidationFeatureEnableEXT checks[] = {
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT,
        VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_EXT,
        VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_RESERVE_BINDING_SLOT_EXT,
    };
    VkDebugUtilsMessengerCreateInfoEXT messenger = messenger_info(device);
    VkValidationFeaturesEXT features = {
        .sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
        .pNext = &messenger,
        .enabledValidationFeatureCount =
            device->validation_of_shaders ? sizeof checks / sizeof *checks : 1,
        .pEnabledValidationFeatures = checks,
    };
    VkApplicationInfo application = {
        .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
        .pApplicationName = "whit",
        .pEngineName = "whit",
        .apiVersion = VK_API_VERSION_1_2,
    };
    VkInstanceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
        .pNext = device->validation ? &features : NULL,
        .flags = extensions & 2u ? VK_INSTANCE_CREATE_ENUMERATE_PORTABILITY_BIT_KHR : 0,
        .pApplicationInfo = &application,
        .enabledLayerCount = device->validation ? 1 : 0,
        .ppEnabledLayerNames = &validation_layer,
        .enabledExtensionCount = enabled_count,
        .ppEnabledExtensionNames = enabled,
    };
    VkResult vk = VK_SUCCESS;
    if (device_may_call(device, "vkCreateInstance", &vk))
        vk = LAYERS_ALONE(vkCreateInstance(&info, NULL, &device->instance));
    if (vk == VK_ERROR_INCOMPATIBLE_DRIVER)
        return refuse(device, "no Vulkan driver could be loaded", install_driver,
                      WHIT_ERROR_NO_DEVICE);
    return device_check(device, vk, "vkCreateInstance", __FILE__, __LINE__);
}

static whit_result make_messenger(struct device *device)
{
    whit_result result = WHIT_OK;
    PFN_vkCreateDebugUtilsMessengerEXT create_messenger =
        (PFN_vkCreateDebugUtilsMessengerEXT)LAYERS_BESIDE(
            vkGetInstanceProcAddr(device->instance, "vkCreateDebugUtilsMessengerEXT"));
    VkDebugUtilsMessengerCreateInfoEXT info = messenger_info(device);
    if (create_messenger)
        VK_TRY(device, create_messenger(device->instance, &info, NULL, &device->messenger));
fail:
    return result;
}

static whit_result make_surface(struct device *device)
{
    const struct device_surface *source = device->surface_source;
    if (!source)
        return WHIT_OK;
    VkResult vk = VK_SUCCESS;
    if (device_may_call(device, "vkCreateSurface", &vk))
        vk = (VkResult)LAYERS_BESIDE(
            source->create(source->user, device->instance, &device->surface));
    return device_check(device, vk, "the window's surface", __FILE__, __LINE__);
}

whit_result instance_create(struct device *device)
{
    static const char *const names[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME,
                                        VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME};
    static const char *const features_name = VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME;
    uint32_t found = 0, features = 0;
    whit_result result = check_loader(device);
    if (result == WHIT_OK)
        result = find_extensions(device, NULL, names, 2, &found);
    if (result == WHIT_OK && device->validation)
        result = find_validation(device);
    if (result == WHIT_OK && device->validation)
        result = find_extensions(device, validation_layer, &features_name, 1, &features);
    if (result == WHIT_OK && device->validation && (!features || !(found & 1u)))
        result =
            refuse(device, "validation was asked for, but its layer cannot be used",
                   "it lacks VK_EXT_validation_features or VK_EXT_debug_utils", WHIT_ERROR_DEVICE);
    if (result == WHIT_OK)
        result = make_instance(device, found, names, 2, features != 0);
    device->debug_utils = (found & 1u) != 0;
    if (result == WHIT_OK && device->validation)
        result = make_messenger(device);
    return result == WHIT_OK ? make_surface(device) : result;
}

void instance_destroy(struct device *device)
{
    if (!device->instance)
        return;
    if (device->messenger) {
        PFN_vkDestroyDebugUtilsMessengerEXT destroy_messenger =
            (PFN_vkDestroyDebugUtilsMessengerEXT)LAYERS_BESIDE(
                vkGetInstanceProcAddr(device->instance, "vkDestroyDebugUtilsMessengerEXT"));
        LAYERS_BESIDE(destroy_messenger(device->instance, device->messenger, NULL));
    }
    if (device->surface)
        LAYERS_BESIDE(vkDestroySurfaceKHR(device->instance, device->surface, NULL));
    LAYERS_ALONE(vkDestroyInstance(device->instance, NULL));
    device->instance = NULL;
}

static bool presents(VkPhysicalDevice physical, uint32_t family, VkQueueFlags flags,
                     VkSurfaceKHR surface)
{
    VkBool32 supported = VK_FALSE;
    return (flags & VK_QUEUE_GRAPHICS_BIT) &&
           LAYERS_BESIDE(
               vkGetPhysicalDeviceSurfaceSupportKHR(physical, family, surface, &supported)) >= 0 &&
           supported;
}

bool instance_queue_family(VkPhysicalDevice physical, VkSurfaceKHR surface, uint32_t *family,
                           uint32_t *timestamp_bits)
{
    VkQueueFamilyProperties families[32];
    uint32_t count = sizeof families / sizeof *families;
    bool found = false;
    LAYERS_BESIDE(vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families));
    *timestamp_bits = 0;
    for (uint32_t i = 0; i < count; ++i) {
        if (!(families[i].queueFlags & VK_QUEUE_COMPUTE_BIT))
            continue;
        if (surface && !presents(physical, i, families[i].queueFlags, surface))
            continue;
        if (found && (*timestamp_bits > 0 || families[i].timestampValidBits == 0))
            continue;
        found = true;
        *family = i;
        *timestamp_bits = families[i].timestampValidBits;
    }
    return found;
}

const char *whit_device_kind_name(whit_device_kind kind)
{
    static const char *const names[] = {
        [WHIT_DEVICE_DISCRETE] = "discrete gpu", [WHIT_DEVICE_INTEGRATED] = "integrated gpu",
        [WHIT_DEVICE_VIRTUAL] = "virtual gpu",   [WHIT_DEVICE_CPU] = "cpu",
        [WHIT_DEVICE_OTHER] = "other",
    };
    return (size_t)kind < sizeof names / sizeof *names ? names[kind] : "";
}

static whit_device_kind kind_of(VkPhysicalDeviceType type)
{
    return type == VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU     ? WHIT_DEVICE_DISCRETE
           : type == VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU ? WHIT_DEVICE_INTEGRATED
           : type == VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU    ? WHIT_DEVICE_VIRTUAL
           : type == VK_PHYSICAL_DEVICE_TYPE_CPU            ? WHIT_DEVICE_CPU
                                                            : WHIT_DEVICE_OTHER;
}

static uint64_t device_memory(VkPhysicalDevice physical)
{
    VkPhysicalDeviceMemoryProperties memory;
    uint64_t largest = 0;
    LAYERS_BESIDE(vkGetPhysicalDeviceMemoryProperties(physical, &memory));
    for (uint32_t i = 0; i < memory.memoryHeapCount; ++i)
        if ((memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) &&
            memory.memoryHeaps[i].size > largest)
            largest = memory.memoryHeaps[i].size;
    return largest;
}

/* Mesa 22.3.6 ends the loops of an invocation after 65,535 iterations in all, 25.0.7 does not. A
   version that cannot be read counts as one that ends them. */
static bool lavapipe_ends_loops(const char *driver_info)
{
    const char *mesa = strstr(driver_info, "Mesa ");
    return !mesa || strtoul(mesa + 5, NULL, 10) < 25;
}

/* Fills in what Vulkan tells of devices of version 1.2 and later; `limits` may be NULL. */
static void fill_details(VkPhysicalDevice physical, whit_device_info *info,
                         struct device_limits *limits)
{
    VkPhysicalDeviceVulkan12Properties v12 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES};
    VkPhysicalDeviceVulkan11Properties v11 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES, .pNext = &v12};
    VkPhysicalDeviceProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &v11};
    LAYERS_BESIDE(vkGetPhysicalDeviceProperties2(physical, &properties));
    snprintf(info->driver, sizeof info->driver, "%.127s %.127s", v12.driverName, v12.driverInfo);
    info->subgroup_size = v11.subgroupSize;

    VkPhysicalDeviceFeatures features;
    LAYERS_BESIDE(vkGetPhysicalDeviceFeatures(physical, &features));
    info->float64 = features.shaderFloat64;
    info->int64 = features.shaderInt64;
    if (limits)
        *limits = (struct device_limits){
            .max_texel_elements = properties.properties.limits.maxTexelBufferElements,
            .max_allocation_bytes = v11.maxMemoryAllocationSize,
            .asked_nearest = v12.shaderRoundingModeRTEFloat32,
            .asked_special = v12.shaderSignedZeroInfNanPreserveFloat32,
            .asked_denormals = v12.shaderDenormPreserveFloat32,
            .loop_limited =
                v12.driverID == VK_DRIVER_ID_MESA_LLVMPIPE && lavapipe_ends_loops(v12.driverInfo),
        };
}

static void fill_info(VkPhysicalDevice physical, VkSurfaceKHR surface, uint32_t index,
                      whit_device_info *info)
{
    VkPhysicalDeviceProperties properties;
    LAYERS_BESIDE(vkGetPhysicalDeviceProperties(physical, &properties));
    const VkPhysicalDeviceLimits *limits = &properties.limits;
    uint32_t version = properties.apiVersion;
    uint32_t family, timestamp_bits;
    bool computes = instance_queue_family(physical, surface, &family, &timestamp_bits);

    *info = (whit_device_info){
        .index = index,
        .kind = kind_of(properties.deviceType),
        .memory_bytes = device_memory(physical),
        .max_storage_range_bytes = limits->maxStorageBufferRange,
        .timestamps = timestamp_bits > 0 && limits->timestampPeriod > 0.0f,
        .usable = true,
    };
    snprintf(info->name, sizeof info->name, "%s", properties.deviceName);
    snprintf(info->api_version, sizeof info->api_version, "%u.%u.%u", VK_API_VERSION_MAJOR(version),
             VK_API_VERSION_MINOR(version), VK_API_VERSION_PATCH(version));
    if (version < VK_API_VERSION_1_2) {
        info->usable = false;
        snprintf(info->why_not, sizeof info->why_not, "Vulkan %s, 1.2 is needed",
                 info->api_version);
        return;
    }
    fill_details(physical, info, NULL);
    if (!computes) {
        info->usable = false;
        snprintf(info->why_not, sizeof info->why_not,
                 surface ? "no queue that computes and shows pictures in a window"
                         : "no queue that computes");
    }
}

static bool contains_any_case(const char *text, const char *part)
{
    for (; *text; ++text) {
        size_t i = 0;
        while (part[i] && tolower((unsigned char)text[i]) == tolower((unsigned char)part[i]))
            ++i;
        if (!part[i])
            return true;
    }
    return false;
}

/* How well a device matches the selector: lower is better, negative is no match. */
static int rank(const whit_device_info *info, const char *selector)
{
    bool numeric = selector[strspn(selector, "0123456789")] == '\0';
    if (strcmp(selector, "auto") == 0)
        return info->usable ? (int)info->kind : -1;
    if (numeric)
        return strtoull(selector, NULL, 10) == info->index ? 0 : -1;
    if (!contains_any_case(info->name, selector))
        return -1;
    return info->usable ? 0 : 1;
}

/* Index of the first of the best matches; WHIT_NONE: none matches. */
static uint32_t best_of(const whit_device_info *infos, uint32_t count, const char *selector)
{
    uint32_t best = WHIT_NONE;
    int best_rank = -1;
    for (uint32_t i = 0; i < count; ++i) {
        int this_rank = rank(&infos[i], selector);
        if (this_rank >= 0 && (best_rank < 0 || this_rank < best_rank)) {
            best_rank = this_rank;
            best = i;
        }
    }
    return best;
}

/* Lists the physical devices. Two blocks to free(): the handles and what is known of them. */
static whit_result list_physical(struct device *device, VkPhysicalDevice **handles,
                                 whit_device_info **infos, uint32_t *count)
{
    whit_result result = WHIT_OK;
    *handles = NULL;
    *infos = NULL;
    *count = 0;
    VK_TRY(device, vkEnumeratePhysicalDevices(device->instance, count, NULL));
    *handles = array_alloc_zeroed(*count, sizeof **handles);
    *infos = array_alloc_zeroed(*count, sizeof **infos);
    if (!*handles || !*infos) {
        result = log_failure(&device->log, WHIT_ERROR_MEMORY, "out of memory for %u Vulkan devices",
                             *count);
        goto fail;
    }
    if (*count > 0)
        VK_TRY(device, vkEnumeratePhysicalDevices(device->instance, count, *handles));
    if (*count == 0) {
        result = refuse(device, "no Vulkan device, no driver found its hardware", install_driver,
                        WHIT_ERROR_NO_DEVICE);
        goto fail;
    }
    for (uint32_t i = 0; i < *count; ++i)
        fill_info((*handles)[i], device->surface, i, &(*infos)[i]);
    uint32_t automatic = best_of(*infos, *count, "auto");
    if (automatic != WHIT_NONE)
        (*infos)[automatic].automatic = true;
    return WHIT_OK;
fail:
    free(*handles);
    free(*infos);
    *handles = NULL;
    *infos = NULL;
    *count = 0;
    return result;
}

whit_result device_list(const whit_log *log, whit_device_info **infos, uint32_t *count)
{
    struct device device = {0};
    if (log)
        device.log = log_or_silence(log);
    device_read_fault(&device);
    VkPhysicalDevice *handles = NULL;
    *infos = NULL;
    *count = 0;
    child_hold_forks(); /* as in device_create */
    whit_result result = instance_create(&device);
    if (result == WHIT_OK)
        result = list_physical(&device, &handles, infos, count);
    instance_destroy(&device);
    child_release_forks();
    free(handles);
    return result;
}

static void describe_all(const whit_device_info *infos, uint32_t count, char *text, size_t bytes)
{
    for (uint32_t i = 0; i < count; ++i)
        text_add(text, bytes, "%s%u: %s (%s%s%s)", i ? ", " : "", i, infos[i].name,
                 whit_device_kind_name(infos[i].kind),
                 infos[i].usable ? "" : "; not usable: ", infos[i].why_not);
}

whit_result instance_select(struct device *device, const char *selector)
{
    if (!selector || !*selector)
        selector = "auto";
    VkPhysicalDevice *handles;
    whit_device_info *infos;
    uint32_t count;
    whit_result result = list_physical(device, &handles, &infos, &count);
    if (result != WHIT_OK)
        return result;

    uint32_t best = best_of(infos, count, selector);
    if (best == WHIT_NONE || !infos[best].usable) {
        char all[1024] = "";
        describe_all(infos, count, all, sizeof all);
        if (best != WHIT_NONE)
            log_error(&device->log, "device %u (%s) is not usable: %s", best, infos[best].name,
                      infos[best].why_not);
        else if (strcmp(selector, "auto") == 0)
            log_error(&device->log, "no usable Vulkan device among %s", all);
        else
            log_error(&device->log, "no Vulkan device \"%s\"; there is %s", selector, all);
        result = WHIT_ERROR_NO_DEVICE;
    } else {
        device->physical = handles[best];
        device->info = infos[best];
        fill_details(device->physical, &device->info, &device->limits);
        LAYERS_BESIDE(vkGetPhysicalDeviceProperties(device->physical, &device->properties));
        LAYERS_BESIDE(vkGetPhysicalDeviceMemoryProperties(device->physical, &device->memory));
    }
    free(handles);
    free(infos);
    return result;
}

/* Private to device/: what its handles are made of, and how a Vulkan call is checked.

   Environment, read once by device_create:
   WHIT_FAULT=NAME:N    the N-th checked call of the Vulkan function NAME fails (N counts from 1,
                        NAME `*` is any function) with VK_ERROR_OUT_OF_DEVICE_MEMORY, or
                        VK_ERROR_DEVICE_LOST for vkQueueSubmit and vkWaitForFences. The call itself
                        is not made. NAME:N:RESULT names another result, see struct fault. For tests
                        of the error paths.

   WHIT_POISON=1        buffers without BUFFER_ZEROED start as bytes 0xa5, so that what relies on
                        zeros shows.

   WHIT_STAGING=1       buffers that kernels reach are treated as not host-visible, so that the
                        path of discrete GPUs can be tested on a CPU device. */
#ifndef DEVICE_VULKAN_H
#define DEVICE_VULKAN_H

#include <pthread.h>
#include <stdatomic.h>

#include <vulkan/vulkan.h>

#include "base/cores.h"
#include "device/layers.h"
#include "device/pipeline.h"
#include "device/specialize.h"

enum { STAGING_BYTES = 16 << 20, OBJECT_NAME_BYTES = 64 };

/* WHIT_FAULT=CALL:N[:RESULT]: the N-th of these calls returns the VkResult RESULT in place of its
   own. An error is returned without making the call; any other RESULT after making it. */
struct fault {
    char call[64]; /* "" for none, "*" for any */
    uint32_t at, seen;
    int32_t result; /* 0: out of memory, or device lost in calls that submit or wait */
};

struct device {
    whit_log log;
    struct fault fault;
    bool validation, staged, poisons;
    bool validation_of_shaders; /* GPU-assisted checks too */
    atomic_bool lost;           /* every later call fails at once, in every thread */
    bool abandoned; /* a library that calls Vulkan failed; later messages of the validation layers
                       are ignored */
    atomic_uint validation_messages;

    VkInstance instance;
    const struct device_surface *surface_source; /* during device_create alone */
    VkSurfaceKHR surface;                        /* null: shows nothing */
    VkDebugUtilsMessengerEXT messenger;
    bool debug_utils; /* VK_EXT_debug_utils is on */

    VkPhysicalDevice physical;
    VkPhysicalDeviceProperties properties;
    VkPhysicalDeviceMemoryProperties memory;
    whit_device_info info;
    struct device_limits limits;

    VkDevice vk;
    VkQueue queue; /* a device that shows pictures is used by one thread */
    pthread_mutex_t queue_lock;
    char threads[CORES_NAME_BYTES]; /* name of the driver's threads that have no other */
    uint32_t
        spreads_left; /* so many submissions still try to spread these threads over the cores */
    uint32_t queue_family;
    uint64_t timestamp_mask; /* 0: the queue has none */
    VkPipelineCache cache;
    uint64_t cache_hash; /* of the cache file's contents; 0: no usable file */

    PFN_vkSetDebugUtilsObjectNameEXT set_object_name; /* NULL without validation */
    PFN_vkCmdBeginDebugUtilsLabelEXT begin_label;     /* both NULL without debug_utils */
    PFN_vkCmdEndDebugUtilsLabelEXT end_label;
    /* Both NULL without VK_KHR_pipeline_executable_properties. */
    PFN_vkGetPipelineExecutablePropertiesKHR get_executables;
    PFN_vkGetPipelineExecutableStatisticsKHR get_executable_statistics;

    _Atomic(uint64_t) pipelines_made; /* see device_pipelines_made */
    bool keeps;                       /* keeps pipelines, see kept.c */
    pthread_mutex_t kept_lock;
    struct pipeline *kept; /* the youngest first */
    uint32_t kept_count;

    pthread_mutex_t transfer_lock; /* of the next two, which are made when first needed */
    struct buffer *staging;
    struct commands *transfer;
};

struct buffer {
    struct device *device;
    VkBuffer vk;
    VkDeviceMemory memory;
    VkBufferView texels;
    uint8_t *mapped;   /* NULL: goes through the staging buffer */
    bool fast_to_read; /* mapped, and cached by the CPU */
    uint64_t size_bytes;
    uint32_t uses;
    char name[OBJECT_NAME_BYTES];
};

struct pipeline {
    struct device *device;
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkPipeline vk;
    enum binding_kind *bindings; /* NONE: a gap of the caller's, or not used by the kernel */
    bool *offered;               /* [i]: binding i is no gap of the caller's */
    uint32_t binding_count, storage_count, texels_count;
    struct pipeline_info info;
    uint32_t push_bytes;
    bool asks_statistics;
    char name[OBJECT_NAME_BYTES];
    /* These are set in a pipeline that the device keeps: */
    bool kept;
    uint32_t users;
    uint64_t key[2], code_key[2]; /* of its params; of its specialized code, 0 where unknown */
    struct pipeline *next;
};

struct binding_set {
    struct device *device;
    VkDescriptorPool pool;
    VkDescriptorSet vk; /* null when the pipeline binds nothing */
};

/* Whether a variable of the environment is set, and neither empty nor 0. */
bool environment_on(const char *name);
void device_read_fault(struct device *device);
/* False when the call is not to be made: *vk is then its result. Else *vk is the result to use
   where the call gives VK_SUCCESS. */
bool device_may_call(struct device *device, const char *expression, VkResult *vk);
/* Logs a failure once and maps it; VK_TIMEOUT is WHIT_ERROR_TIME_LIMIT and not logged. A failure
   counts as one of memory or descriptors where less is left than DRIVER_ROOM_BYTES, as much as a
   driver with its compiler takes. */
#define DRIVER_ROOM_BYTES ((uint64_t)512 << 20)
whit_result device_check(struct device *device, VkResult vk, const char *expression,
                         const char *file, int line);
void device_name_object(struct device *device, VkObjectType type, uint64_t handle,
                        const char *name);

/* Makes a Vulkan call; on failure sets `result` and jumps to `fail`. */
#define VK_TRY(device, ...)                                                                        \
    do {                                                                                           \
        VkResult vk_ = VK_SUCCESS;                                                                 \
        if (device_may_call((device), #__VA_ARGS__, &vk_))                                         \
            vk_ = (VkResult)LAYERS_BESIDE(__VA_ARGS__);                                            \
        result = device_check((device), vk_, #__VA_ARGS__, __FILE__, __LINE__);                    \
        if (result != WHIT_OK)                                                                     \
            goto fail;                                                                             \
    } while (0)

#endif

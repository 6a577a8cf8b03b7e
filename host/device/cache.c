/* The pipeline cache and its file; each build of a driver has a file of its own. */
#include "device/cache.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/hash.h"
#include "base/store.h"

/* Whether the data is from this driver: not every driver checks that itself. */
static bool is_of_driver(const struct device *device, const uint8_t *data, size_t data_bytes)
{
    VkPipelineCacheHeaderVersionOne driver;
    if (data_bytes < sizeof driver)
        return false;
    memcpy(&driver, data, sizeof driver);
    return driver.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE &&
           driver.vendorID == device->properties.vendorID &&
           driver.deviceID == device->properties.deviceID &&
           memcmp(driver.pipelineCacheUUID, device->properties.pipelineCacheUUID, VK_UUID_SIZE) ==
               0;
}

whit_result cache_open(struct device *device)
{
    whit_result result = WHIT_OK;
    uint8_t *data = NULL;
    size_t data_bytes = 0;
    char *name = device_kept_name(device, "pipelines");
    bool found = name && store_read(&device->log, name, &data, &data_bytes) &&
                 is_of_driver(device, data, data_bytes);
    if (found)
        device->cache_hash = hash_bytes(HASH_START, data, data_bytes);
    VkPipelineCacheCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO,
        .initialDataSize = found ? data_bytes : 0,
        .pInitialData = found ? data : NULL,
    };
    VK_TRY(device, vkCreatePipelineCache(device->vk, &info, NULL, &device->cache));
    device_name_object(device, VK_OBJECT_TYPE_PIPELINE_CACHE, (uint64_t)device->cache, "pipelines");
fail:
    free(data);
    free(name);
    return result;
}

static void cache_save(struct device *device)
{
    size_t size_bytes = 0;
    if (LAYERS_BESIDE(vkGetPipelineCacheData(device->vk, device->cache, &size_bytes, NULL)) !=
            VK_SUCCESS ||
        size_bytes < sizeof(VkPipelineCacheHeaderVersionOne))
        return;
    uint8_t *data = array_alloc_zeroed(size_bytes, 1);
    char *name = device_kept_name(device, "pipelines");
    if (data && name &&
        LAYERS_BESIDE(vkGetPipelineCacheData(device->vk, device->cache, &size_bytes, data)) ==
            VK_SUCCESS &&
        hash_bytes(HASH_START, data, size_bytes) != device->cache_hash)
        store_write(&device->log, name, data, size_bytes);
    free(name);
    free(data);
}

void cache_close(struct device *device)
{
    if (!device->cache)
        return;
    if (!device->lost)
        cache_save(device);
    LAYERS_BESIDE(vkDestroyPipelineCache(device->vk, device->cache, NULL));
    device->cache = VK_NULL_HANDLE;
}

/* The pipeline cache and its file, one file a driver build. The file has a header of ours with a
   checksum, because drivers need not survive damaged cache data. */
#include "device/vulkan.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/array.h"
#include "base/file.h"

enum { CACHE_LIMIT_BYTES = 256 << 20 };

struct cache_header {
    char magic[8];
    uint64_t data_bytes;
    uint64_t hash;
};

static const char cache_magic[8] = {'w', 'h', 'i', 't', 'p', 'c', '0', '1'};
static const struct log silent;

/* FNV-1a, never 0. */
static uint64_t hash_bytes(const uint8_t *data, size_t size_bytes)
{
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    for (size_t i = 0; i < size_bytes; ++i)
        hash = (hash ^ data[i]) * UINT64_C(0x100000001b3);
    return hash ? hash : 1;
}

bool cache_is_off(void)
{
    const char *value = getenv("WHIT_NO_CACHE");
    return value && *value && strcmp(value, "0") != 0;
}

char *cache_folder(bool make)
{
    const char *xdg = getenv("XDG_CACHE_HOME");
    const char *home = getenv("HOME");
    char *parent = NULL;
    if (xdg && xdg[0] == '/') /* the specification says to ignore relative ones */
        parent = string_copy(xdg);
    else if (home && *home)
        parent = string_format("%s/.cache", home);
    char *folder = parent ? string_format("%s/whit", parent) : NULL;
    if (folder && make) {
        (void)mkdir(parent, 0700);
        (void)mkdir(folder, 0700);
    }
    free(parent);
    return folder;
}

static char *cache_path(const struct device *device, bool make_folder)
{
    char uuid[2 * VK_UUID_SIZE + 1];
    for (size_t i = 0; i < VK_UUID_SIZE; ++i)
        snprintf(uuid + 2 * i, 3, "%02x", device->properties.pipelineCacheUUID[i]);
    char *folder = cache_folder(make_folder);
    char *path = folder ? string_format("%s/pipelines-%04x-%04x-%s%s.bin", folder,
                                        device->properties.vendorID, device->properties.deviceID,
                                        uuid, device->validation ? "-validation" : "")
                        : NULL;
    free(folder);
    return path;
}

/* The driver's data inside our file, or NULL when it is damaged or another driver's. */
static const uint8_t *cache_data(const struct device *device, const uint8_t *file,
                                 size_t file_bytes, size_t *data_bytes, uint64_t *hash)
{
    struct cache_header header;
    VkPipelineCacheHeaderVersionOne driver;
    if (file_bytes < sizeof header + sizeof driver)
        return NULL;
    memcpy(&header, file, sizeof header);
    const uint8_t *data = file + sizeof header;
    *data_bytes = file_bytes - sizeof header;
    if (memcmp(header.magic, cache_magic, sizeof cache_magic) != 0 ||
        header.data_bytes != *data_bytes || header.hash != hash_bytes(data, *data_bytes))
        return NULL;
    memcpy(&driver, data, sizeof driver);
    if (driver.headerVersion != VK_PIPELINE_CACHE_HEADER_VERSION_ONE ||
        driver.vendorID != device->properties.vendorID ||
        driver.deviceID != device->properties.deviceID ||
        memcmp(driver.pipelineCacheUUID, device->properties.pipelineCacheUUID, VK_UUID_SIZE) != 0)
        return NULL;
    *hash = header.hash;
    return data;
}

whit_result cache_open(struct device *device)
{
    whit_result result = WHIT_OK;
    uint8_t *file = NULL;
    size_t file_bytes = 0, data_bytes = 0;
    const uint8_t *data = NULL;
    char *path = cache_is_off() ? NULL : cache_path(device, false);
    if (path && file_exists(path) &&
        file_read(&silent, NULL, path, CACHE_LIMIT_BYTES, &file, &file_bytes) == WHIT_OK) {
        data = cache_data(device, file, file_bytes, &data_bytes, &device->cache_hash);
        if (!data)
            log_debug(&device->log, "%s: damaged or from another driver, ignored", path);
    }
    VkPipelineCacheCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO,
        .initialDataSize = data ? data_bytes : 0,
        .pInitialData = data,
    };
    VK_TRY(device, vkCreatePipelineCache(device->vk, &info, NULL, &device->cache));
    device_name_object(device, VK_OBJECT_TYPE_PIPELINE_CACHE, (uint64_t)device->cache, "pipelines");
fail:
    free(file);
    free(path);
    return result;
}

static bool cache_write(const char *path, const uint8_t *data, size_t size_bytes)
{
    struct cache_header header = {.data_bytes = size_bytes, .hash = hash_bytes(data, size_bytes)};
    memcpy(header.magic, cache_magic, sizeof cache_magic);
    struct file_write file = {0};
    if (file_write_begin(&silent, path, &file) != WHIT_OK)
        return false;
    if (fwrite(&header, sizeof header, 1, file.stream) != 1 ||
        fwrite(data, 1, size_bytes, file.stream) != size_bytes) {
        file_write_abandon(&file);
        return false;
    }
    return file_write_commit(&silent, &file) == WHIT_OK;
}

static void cache_save(struct device *device)
{
    size_t size_bytes = 0;
    if (vkGetPipelineCacheData(device->vk, device->cache, &size_bytes, NULL) != VK_SUCCESS ||
        size_bytes < sizeof(VkPipelineCacheHeaderVersionOne) || size_bytes > CACHE_LIMIT_BYTES)
        return;
    uint8_t *data = array_alloc_zeroed(size_bytes, 1);
    char *path = cache_path(device, true);
    if (data && path &&
        vkGetPipelineCacheData(device->vk, device->cache, &size_bytes, data) == VK_SUCCESS &&
        hash_bytes(data, size_bytes) != device->cache_hash && !cache_write(path, data, size_bytes))
        log_debug(&device->log, "%s: cannot write the pipeline cache", path);
    free(path);
    free(data);
}

void cache_close(struct device *device)
{
    if (!device->cache)
        return;
    if (!device->lost && !cache_is_off())
        cache_save(device);
    vkDestroyPipelineCache(device->vk, device->cache, NULL);
    device->cache = VK_NULL_HANDLE;
}

#include "device/buffer.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/platform.h"
#include "base/threads.h"
#include "device/commands.h"
#include "device/vulkan.h"

enum { TEXEL_BYTES = 16, POISON = 0xa5 };

enum placement {
    PLACE_DEVICE,  /* memory of the device, not mapped */
    PLACE_UNIFIED, /* memory of the device, mapped for the host */
    PLACE_HOST, /* memory of the host, cached where there is such a type, so that the host reads it
                   fast */
};

/* Wanted properties of a memory type for each placement, best first. Vulkan promises every buffer a
   host-visible and coherent type, so incoherent memory, with its flushes, is never needed. */
static const VkMemoryPropertyFlags wanted[][4] = {
    [PLACE_DEVICE] = {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0},
    [PLACE_UNIFIED] = {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                           VK_MEMORY_PROPERTY_HOST_COHERENT_BIT |
                           VK_MEMORY_PROPERTY_HOST_CACHED_BIT,
                       VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                           VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
                       VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT},
    [PLACE_HOST] = {VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT |
                        VK_MEMORY_PROPERTY_HOST_CACHED_BIT,
                    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT},
};

/* A memory type with any other property needs a device feature that whit does not enable. */
static const VkMemoryPropertyFlags understood =
    VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
    VK_MEMORY_PROPERTY_HOST_COHERENT_BIT | VK_MEMORY_PROPERTY_HOST_CACHED_BIT;

static bool find_memory_type(const struct device *device, uint32_t type_bits,
                             enum placement placement, uint32_t *type)
{
    for (size_t i = 0; i < sizeof wanted[0] / sizeof wanted[0][0]; ++i) {
        VkMemoryPropertyFlags want = wanted[placement][i];
        if (want == 0 && placement != PLACE_DEVICE)
            return false;
        for (uint32_t j = 0; j < device->memory.memoryTypeCount; ++j) {
            VkMemoryPropertyFlags flags = device->memory.memoryTypes[j].propertyFlags;
            if ((type_bits >> j & 1) && (flags & want) == want && !(flags & ~understood)) {
                *type = j;
                return true;
            }
        }
        if (want == 0)
            return false;
    }
    return false;
}

/* A device with a memory of its own reaches the host's memory through a bus of some 25 GB/s. So
   buffers that its kernels use lie in its own memory, and the host reads and writes them by copies
   through the staging buffer. */
static enum placement placement_for(const struct device *device, uint32_t uses)
{
    bool one_memory =
        device->info.kind == WHIT_DEVICE_CPU || device->info.kind == WHIT_DEVICE_INTEGRATED;
    bool in_kernels = uses & (BUFFER_STORAGE | BUFFER_TEXELS | BUFFER_INDIRECT);
    if (in_kernels && (!one_memory || device->staged))
        return PLACE_DEVICE;
    return uses & BUFFER_HOST ? PLACE_HOST : PLACE_UNIFIED;
}

/* Writes whole MiB as "128 MiB", all other sizes in bytes. */
static void describe_size(uint64_t bytes, char *text, size_t text_bytes)
{
    if (bytes >= 1 << 20 && bytes % (1 << 20) == 0)
        snprintf(text, text_bytes, "%" PRIu64 " MiB", bytes >> 20);
    else
        snprintf(text, text_bytes, "%" PRIu64 " bytes", bytes);
}

static whit_result check_limit(const struct buffer *buffer, uint64_t size_bytes, uint64_t limit,
                               const char *what)
{
    if (size_bytes <= limit)
        return WHIT_OK;
    char size[32], max[32];
    describe_size(size_bytes, size, sizeof size);
    describe_size(limit, max, sizeof max);
    return log_failure(&buffer->device->log, WHIT_ERROR_DEVICE,
                       "buffer \"%s\": %s is over the device's limit of %s for %s", buffer->name,
                       size, max, what);
}

static whit_result check_limits(const struct buffer *buffer, uint64_t size_bytes)
{
    const struct device_limits *limits = &buffer->device->limits;
    uint64_t max_storage = buffer->device->info.max_storage_range_bytes;
    whit_result result = WHIT_OK;
    if (buffer->uses & BUFFER_STORAGE)
        result = check_limit(buffer, size_bytes, max_storage, "a storage buffer");
    if (result == WHIT_OK && (buffer->uses & BUFFER_TEXELS))
        result = check_limit(buffer, size_bytes, limits->max_texel_elements * TEXEL_BYTES,
                             "a texel buffer");
    if (result == WHIT_OK)
        result = check_limit(buffer, size_bytes, limits->max_allocation_bytes, "one allocation");
    return result;
}

/* The size that the Vulkan buffer gets. lavapipe compiles a kernel anew for each kind of texel
   buffer, and takes those for kinds of their own whose size is a power of two, or has zeros in bits
   8 to 15, which it reads as a number of mipmap levels. Buffers of small scenes have all these
   kinds; padding by a few bytes makes them one kind. */
static uint64_t vulkan_bytes(const struct buffer *buffer)
{
    const struct device_limits *limits = &buffer->device->limits;
    uint64_t bytes = buffer->size_bytes;
    if (!(buffer->uses & BUFFER_TEXELS) || buffer->device->info.kind != WHIT_DEVICE_CPU)
        return bytes;
    if ((bytes >> 8 & 0xff) == 0)
        bytes += 256;
    if ((bytes & (bytes - 1)) == 0)
        bytes += TEXEL_BYTES;
    return bytes <= limits->max_texel_elements * TEXEL_BYTES &&
                   bytes <= limits->max_allocation_bytes
               ? bytes
               : buffer->size_bytes;
}

/* Memory of a CPU device is the process's own. The first touch of a page of 4 KiB takes longer than
   filling it, and a kernel touches many; so a large buffer starts and ends at a boundary of a large
   page (2 MiB). */
static bool is_large(const struct device *device, enum placement placement, uint64_t size_bytes)
{
    return device->info.kind == WHIT_DEVICE_CPU && placement != PLACE_DEVICE &&
           size_bytes >= LARGE_PAGE_BYTES / 2 &&
           size_bytes <= device->limits.max_allocation_bytes - 2 * LARGE_PAGE_BYTES;
}

static uint64_t round_to_large(uint64_t bytes)
{
    return (bytes + LARGE_PAGE_BYTES - 1) / LARGE_PAGE_BYTES * LARGE_PAGE_BYTES;
}

static whit_result allocate(struct buffer *buffer)
{
    struct device *device = buffer->device;
    enum placement placement = placement_for(device, buffer->uses);
    whit_result result = WHIT_OK;
    VkBufferCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
        .size = vulkan_bytes(buffer),
        .usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
    };
    if (buffer->uses & BUFFER_STORAGE)
        info.usage |= VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    if (buffer->uses & BUFFER_TEXELS)
        info.usage |= VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
    if (buffer->uses & BUFFER_INDIRECT)
        info.usage |= VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
    VK_TRY(device, vkCreateBuffer(device->vk, &info, NULL, &buffer->vk));

    VkMemoryRequirements needs;
    LAYERS_BESIDE(vkGetBufferMemoryRequirements(device->vk, buffer->vk, &needs));
    bool large = is_large(device, placement, needs.size);
    VkMemoryAllocateInfo allocation = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
        .allocationSize = large ? round_to_large(needs.size) + LARGE_PAGE_BYTES : needs.size,
    };
    if (!find_memory_type(device, needs.memoryTypeBits, placement, &allocation.memoryTypeIndex))
        return log_failure(&device->log, WHIT_ERROR_DEVICE,
                           "buffer \"%s\": the device has no memory for it", buffer->name);
    VK_TRY(device, vkAllocateMemory(device->vk, &allocation, NULL, &buffer->memory));
    uint64_t offset_bytes = 0;
    if (placement != PLACE_DEVICE) {
        VkMemoryPropertyFlags flags =
            device->memory.memoryTypes[allocation.memoryTypeIndex].propertyFlags;
        void *mapped = NULL;
        VK_TRY(device, vkMapMemory(device->vk, buffer->memory, 0, VK_WHOLE_SIZE, 0, &mapped));
        offset_bytes = large ? round_to_large((uintptr_t)mapped) - (uintptr_t)mapped : 0;
        buffer->mapped = (uint8_t *)mapped + offset_bytes;
        buffer->fast_to_read = (flags & VK_MEMORY_PROPERTY_HOST_CACHED_BIT) != 0;
        if (large)
            platform_expect_much(buffer->mapped, round_to_large(needs.size));
    }
    VK_TRY(device, vkBindBufferMemory(device->vk, buffer->vk, buffer->memory, offset_bytes));
fail:
    return result;
}

static whit_result make_view(struct buffer *buffer)
{
    struct device *device = buffer->device;
    whit_result result = WHIT_OK;
    VkFormatProperties format;
    LAYERS_BESIDE(vkGetPhysicalDeviceFormatProperties(device->physical, VK_FORMAT_R32G32B32A32_UINT,
                                                      &format));
    if (!(format.bufferFeatures & VK_FORMAT_FEATURE_UNIFORM_TEXEL_BUFFER_BIT))
        return log_failure(&device->log, WHIT_ERROR_DEVICE,
                           "buffer \"%s\": the device has no texel buffers of four uint32",
                           buffer->name);
    VkBufferViewCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
        .buffer = buffer->vk,
        .format = VK_FORMAT_R32G32B32A32_UINT,
        .range = vulkan_bytes(buffer),
    };
    VK_TRY(device, vkCreateBufferView(device->vk, &info, NULL, &buffer->texels));
    device_name_object(device, VK_OBJECT_TYPE_BUFFER_VIEW, (uint64_t)buffer->texels, buffer->name);
fail:
    return result;
}

static whit_result transfer_ready(struct device *device)
{
    whit_result result = WHIT_OK;
    if (!device->transfer)
        result = commands_create(device, "transfer", &device->transfer);
    return result;
}

static whit_result fill(struct buffer *buffer, uint8_t byte)
{
    struct device *device = buffer->device;
    if (buffer->mapped) {
        if (byte == 0 && device->info.kind == WHIT_DEVICE_CPU)
            platform_zero(buffer->mapped, buffer->size_bytes);
        else
            memset(buffer->mapped, byte, buffer->size_bytes);
        return WHIT_OK;
    }
    pthread_mutex_lock(&device->transfer_lock);
    whit_result result = transfer_ready(device);
    if (result == WHIT_OK)
        result = commands_begin(device->transfer);
    if (result == WHIT_OK) {
        commands_fill(device->transfer, buffer, 0, buffer->size_bytes, 0x01010101u * byte);
        result = commands_run(device->transfer);
    }
    pthread_mutex_unlock(&device->transfer_lock);
    return result;
}

whit_result buffer_create(struct device *device, uint64_t size_bytes, uint32_t uses,
                          const char *name, struct buffer **out)
{
    *out = NULL;
    struct buffer *buffer = array_alloc_zeroed(1, sizeof *buffer);
    if (!buffer)
        return log_failure(&device->log, WHIT_ERROR_MEMORY, "out of memory for buffer \"%s\"",
                           name ? name : "");
    buffer->device = device;
    buffer->uses = uses;
    snprintf(buffer->name, sizeof buffer->name, "%s", name ? name : "");

    whit_result result = check_limits(buffer, size_bytes);
    if (result == WHIT_OK) {
        buffer->size_bytes = size_bytes == 0 ? TEXEL_BYTES : (size_bytes + 15) & ~UINT64_C(15);
        result = check_limits(buffer, buffer->size_bytes);
    }
    if (result == WHIT_OK)
        result = allocate(buffer);
    if (result == WHIT_OK) {
        device_name_object(device, VK_OBJECT_TYPE_BUFFER, (uint64_t)buffer->vk, buffer->name);
        device_name_object(device, VK_OBJECT_TYPE_DEVICE_MEMORY, (uint64_t)buffer->memory,
                           buffer->name);
    }
    if (result == WHIT_OK && (uses & BUFFER_TEXELS))
        result = make_view(buffer);
    if (result == WHIT_OK && ((uses & BUFFER_ZEROED) || device->poisons))
        result = fill(buffer, uses & BUFFER_ZEROED ? 0 : POISON);
    if (result != WHIT_OK) {
        buffer_destroy(buffer);
        return result;
    }
    *out = buffer;
    return WHIT_OK;
}

whit_result buffer_create_all(struct device *device, const struct buffer_request *all, size_t count,
                              uint64_t *bytes)
{
    whit_result result = WHIT_OK;
    for (size_t i = 0; result == WHIT_OK && i < count; ++i) {
        if (all[i].size_bytes == 0)
            continue;
        if (!*all[i].buffer)
            result =
                buffer_create(device, all[i].size_bytes, all[i].uses, all[i].name, all[i].buffer);
        *bytes += result == WHIT_OK ? all[i].size_bytes : 0;
    }
    return result;
}

void buffer_destroy(struct buffer *buffer)
{
    if (!buffer)
        return;
    VkDevice vk = buffer->device->vk;
    LAYERS_BESIDE(vkDestroyBufferView(vk, buffer->texels, NULL));
    LAYERS_BESIDE(vkDestroyBuffer(vk, buffer->vk, NULL));
    LAYERS_BESIDE(vkFreeMemory(vk, buffer->memory, NULL));
    free(buffer);
}

uint64_t buffer_size(const struct buffer *buffer)
{
    return buffer->size_bytes;
}

static whit_result check_access(const struct buffer *buffer, uint64_t offset_bytes,
                                uint64_t size_bytes)
{
    if (buffer->device->lost)
        return WHIT_ERROR_DEVICE;
    if (offset_bytes <= buffer->size_bytes && size_bytes <= buffer->size_bytes - offset_bytes)
        return WHIT_OK;
    return log_usage(&buffer->device->log,
                     "buffer \"%s\" of %" PRIu64 " bytes: access to %" PRIu64 " bytes at %" PRIu64,
                     buffer->name, buffer->size_bytes, size_bytes, offset_bytes);
}

static whit_result staging_ready(struct device *device)
{
    whit_result result = transfer_ready(device);
    if (result == WHIT_OK && !device->staging)
        result = buffer_create(device, STAGING_BYTES, BUFFER_HOST, "staging", &device->staging);
    return result;
}

/* A copy into the memory of a device, in parts that several threads take: the system clears pages
   when they are first written, which takes longer than the copy. */
enum { COPY_PART_BYTES = 4 << 20 };
struct copy {
    uint8_t *to;
    const uint8_t *from;
    uint64_t bytes;
};

static void copy_part(void *context, uint32_t part)
{
    const struct copy *copy = context;
    uint64_t at = (uint64_t)part * COPY_PART_BYTES, left = copy->bytes - at;
    memcpy(copy->to + at, copy->from + at, left < COPY_PART_BYTES ? left : COPY_PART_BYTES);
}

static void copy_in(uint8_t *to, const uint8_t *from, uint64_t bytes)
{
    struct copy copy = {to, from, bytes};
    threads_for(0, (uint32_t)((bytes + COPY_PART_BYTES - 1) / COPY_PART_BYTES), copy_part, &copy);
}

whit_result buffer_write(struct buffer *buffer, uint64_t offset_bytes, const void *data,
                         uint64_t size_bytes)
{
    struct device *device = buffer->device;
    const uint8_t *from = data;
    whit_result result = check_access(buffer, offset_bytes, size_bytes);
    if (result != WHIT_OK || size_bytes == 0)
        return result;
    if (buffer->mapped) {
        copy_in(buffer->mapped + offset_bytes, from, size_bytes);
        return WHIT_OK;
    }
    pthread_mutex_lock(&device->transfer_lock);
    result = staging_ready(device);
    for (uint64_t done = 0; result == WHIT_OK && done < size_bytes;) {
        uint64_t part = size_bytes - done < STAGING_BYTES ? size_bytes - done : STAGING_BYTES;
        memcpy(device->staging->mapped, from + done, part);
        result = commands_begin(device->transfer);
        if (result != WHIT_OK)
            break;
        commands_copy(device->transfer, device->staging, 0, buffer, offset_bytes + done, part);
        result = commands_run(device->transfer);
        done += part;
    }
    pthread_mutex_unlock(&device->transfer_lock);
    return result;
}

/* A host buffer that is not cached is read directly too: the staging buffer would be no faster. */
void *buffer_contents(const struct buffer *buffer)
{
    bool direct = buffer->fast_to_read || (buffer->uses & BUFFER_HOST);
    return direct ? buffer->mapped : NULL;
}

whit_result buffer_read(struct buffer *buffer, uint64_t offset_bytes, void *data,
                        uint64_t size_bytes)
{
    struct device *device = buffer->device;
    uint8_t *to = data;
    whit_result result = check_access(buffer, offset_bytes, size_bytes);
    if (result != WHIT_OK || size_bytes == 0)
        return result;
    const uint8_t *from = buffer_contents(buffer);
    if (from) {
        memcpy(to, from + offset_bytes, size_bytes);
        return WHIT_OK;
    }
    pthread_mutex_lock(&device->transfer_lock);
    result = staging_ready(device);
    for (uint64_t done = 0; result == WHIT_OK && done < size_bytes;) {
        uint64_t part = size_bytes - done < STAGING_BYTES ? size_bytes - done : STAGING_BYTES;
        result = commands_begin(device->transfer);
        if (result != WHIT_OK)
            break;
        commands_copy(device->transfer, buffer, offset_bytes + done, device->staging, 0, part);
        result = commands_run(device->transfer);
        if (result == WHIT_OK)
            memcpy(to + done, device->staging->mapped, part);
        done += part;
    }
    pthread_mutex_unlock(&device->transfer_lock);
    return result;
}

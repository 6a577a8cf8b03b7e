#include "device/commands_private.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/array.h"
#include "device/buffer.h"

enum commands_state { COMMANDS_IDLE, COMMANDS_RECORDING, COMMANDS_IN_FLIGHT };

struct commands {
    struct device *device;
    VkCommandPool pool;
    VkCommandBuffer vk;
    VkFence fence;
    VkQueryPool queries; /* null without timestamps */
    enum commands_state state;
    const struct pipeline *bound;
    whit_result recording; /* the first error of this recording, already logged */
    bool span_open;
    uint32_t span_count;          /* of this recording */
    uint32_t finished_span_count; /* of the last finished submission */
    double span_ms[COMMANDS_SPANS];
    char name[OBJECT_NAME_BYTES];
};

static whit_result make_commands(struct commands *commands)
{
    struct device *device = commands->device;
    const char *name = commands->name;
    whit_result result = WHIT_OK;
    VkCommandPoolCreateInfo pool = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
        .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
        .queueFamilyIndex = device->queue_family,
    };
    VK_TRY(device, vkCreateCommandPool(device->vk, &pool, NULL, &commands->pool));
    device_name_object(device, VK_OBJECT_TYPE_COMMAND_POOL, (uint64_t)commands->pool, name);
    VkCommandBufferAllocateInfo buffer = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = commands->pool,
        .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
        .commandBufferCount = 1,
    };
    VK_TRY(device, vkAllocateCommandBuffers(device->vk, &buffer, &commands->vk));
    device_name_object(device, VK_OBJECT_TYPE_COMMAND_BUFFER, (uint64_t)commands->vk, name);
    VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    VK_TRY(device, vkCreateFence(device->vk, &fence, NULL, &commands->fence));
    device_name_object(device, VK_OBJECT_TYPE_FENCE, (uint64_t)commands->fence, name);
    if (device->timestamp_mask != 0) {
        VkQueryPoolCreateInfo queries = {
            .sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
            .queryType = VK_QUERY_TYPE_TIMESTAMP,
            .queryCount = 2 * COMMANDS_SPANS,
        };
        VK_TRY(device, vkCreateQueryPool(device->vk, &queries, NULL, &commands->queries));
        device_name_object(device, VK_OBJECT_TYPE_QUERY_POOL, (uint64_t)commands->queries, name);
    }
fail:
    return result;
}

whit_result commands_create(struct device *device, const char *name, struct commands **out)
{
    *out = NULL;
    struct commands *commands = array_alloc_zeroed(1, sizeof *commands);
    if (!commands)
        return log_failure(&device->log, WHIT_ERROR_MEMORY, "out of memory for commands \"%s\"",
                           name ? name : "");
    commands->device = device;
    snprintf(commands->name, sizeof commands->name, "%s", name ? name : "");
    whit_result result = make_commands(commands);
    if (result != WHIT_OK) {
        commands_destroy(commands);
        return result;
    }
    *out = commands;
    return WHIT_OK;
}

void commands_destroy(struct commands *commands)
{
    if (!commands)
        return;
    VkDevice vk = commands->device->vk;
    /* Waits for a lost device too: that returns at once, and nothing in use is destroyed. */
    if (commands->state == COMMANDS_IN_FLIGHT)
        (void)LAYERS_BESIDE(vkWaitForFences(vk, 1, &commands->fence, VK_TRUE, UINT64_MAX));
    LAYERS_BESIDE(vkDestroyQueryPool(vk, commands->queries, NULL));
    LAYERS_BESIDE(vkDestroyFence(vk, commands->fence, NULL));
    LAYERS_BESIDE(vkDestroyCommandPool(vk, commands->pool, NULL));
    free(commands);
}

/* Logs the first error of a recording, which commands_submit returns. */
#define RECORDING_FAILS(commands, code, ...)                                                       \
    do {                                                                                           \
        if ((commands)->recording == WHIT_OK) {                                                    \
            log_error(&(commands)->device->log, __VA_ARGS__);                                      \
            (commands)->recording = (code);                                                        \
        }                                                                                          \
    } while (0)

/* True when a command may be recorded. */
static bool is_recording(struct commands *commands)
{
    if (commands->state != COMMANDS_RECORDING)
        RECORDING_FAILS(commands, WHIT_ERROR_USAGE,
                        "commands \"%s\": a command outside begin and "
                        "submit",
                        commands->name);
    return commands->state == COMMANDS_RECORDING && commands->recording == WHIT_OK;
}

whit_result commands_begin(struct commands *commands)
{
    struct device *device = commands->device;
    whit_result result = WHIT_OK;
    if (commands->state == COMMANDS_IN_FLIGHT)
        return log_usage(&device->log, "commands \"%s\" begun again while in flight",
                         commands->name);
    VkCommandBufferBeginInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
        .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
    };
    commands->state = COMMANDS_IDLE;
    VK_TRY(device, vkResetCommandPool(device->vk, commands->pool, 0));
    VK_TRY(device, vkBeginCommandBuffer(commands->vk, &info));
    commands->state = COMMANDS_RECORDING;
    commands->recording = WHIT_OK;
    commands->bound = NULL;
    commands->span_open = false;
    commands->span_count = 0;
    if (commands->queries)
        LAYERS_BESIDE(vkCmdResetQueryPool(commands->vk, commands->queries, 0, 2 * COMMANDS_SPANS));
    if (device->begin_label) {
        VkDebugUtilsLabelEXT label = {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT,
                                      .pLabelName = commands->name};
        LAYERS_BESIDE(device->begin_label(commands->vk, &label));
    }
    commands_barrier(commands); /* makes what earlier submissions wrote visible */
fail:
    return result;
}

void commands_bind(struct commands *commands, struct pipeline *pipeline, struct binding_set *set)
{
    if (!is_recording(commands))
        return;
    commands->bound = pipeline;
    LAYERS_BESIDE(vkCmdBindPipeline(commands->vk, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline->vk));
    if (set && set->vk)
        LAYERS_BESIDE(vkCmdBindDescriptorSets(commands->vk, VK_PIPELINE_BIND_POINT_COMPUTE,
                                              pipeline->layout, 0, 1, &set->vk, 0, NULL));
}

void commands_push(struct commands *commands, const void *data, uint32_t size_bytes)
{
    if (!is_recording(commands))
        return;
    if (!commands->bound || size_bytes == 0 || size_bytes % 4 != 0 ||
        size_bytes > commands->bound->push_bytes) {
        RECORDING_FAILS(commands, WHIT_ERROR_USAGE,
                        "commands \"%s\": %u bytes of push constants for pipeline \"%s\"",
                        commands->name, size_bytes,
                        commands->bound ? commands->bound->name : "(none)");
        return;
    }
    LAYERS_BESIDE(vkCmdPushConstants(commands->vk, commands->bound->layout,
                                     VK_SHADER_STAGE_COMPUTE_BIT, 0, size_bytes, data));
}

void commands_dispatch(struct commands *commands, uint32_t groups_x, uint32_t groups_y,
                       uint32_t groups_z)
{
    if (!is_recording(commands))
        return;
    const uint32_t *max = commands->device->properties.limits.maxComputeWorkGroupCount;
    if (!commands->bound) {
        RECORDING_FAILS(commands, WHIT_ERROR_USAGE, "commands \"%s\": dispatch without a pipeline",
                        commands->name);
        return;
    }
    if (groups_x > max[0] || groups_y > max[1] || groups_z > max[2]) {
        RECORDING_FAILS(commands, WHIT_ERROR_DEVICE,
                        "pipeline \"%s\": %u x %u x %u groups; the device's limit is %u x %u x %u",
                        commands->bound->name, groups_x, groups_y, groups_z, max[0], max[1],
                        max[2]);
        return;
    }
    LAYERS_BESIDE(vkCmdDispatch(commands->vk, groups_x, groups_y, groups_z));
}

static bool fits(const struct buffer *buffer, uint64_t offset_bytes, uint64_t size_bytes)
{
    return offset_bytes % 4 == 0 && offset_bytes <= buffer->size_bytes &&
           size_bytes <= buffer->size_bytes - offset_bytes;
}

void commands_dispatch_indirect(struct commands *commands, struct buffer *buffer,
                                uint64_t offset_bytes)
{
    if (!is_recording(commands))
        return;
    if (!commands->bound || !(buffer->uses & BUFFER_INDIRECT) ||
        !fits(buffer, offset_bytes, sizeof(VkDispatchIndirectCommand))) {
        RECORDING_FAILS(commands, WHIT_ERROR_USAGE,
                        "commands \"%s\": indirect dispatch from buffer \"%s\" at %" PRIu64,
                        commands->name, buffer->name, offset_bytes);
        return;
    }
    LAYERS_BESIDE(vkCmdDispatchIndirect(commands->vk, buffer->vk, offset_bytes));
}

void commands_barrier(struct commands *commands)
{
    if (!is_recording(commands))
        return;
    const VkPipelineStageFlags stages =
        VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT |
        VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_HOST_BIT;
    VkMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
        .srcAccessMask =
            VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_HOST_WRITE_BIT,
        .dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT |
                         VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT |
                         VK_ACCESS_INDIRECT_COMMAND_READ_BIT | VK_ACCESS_HOST_READ_BIT,
    };
    LAYERS_BESIDE(
        vkCmdPipelineBarrier(commands->vk, stages, stages, 0, 1, &barrier, 0, NULL, 0, NULL));
}

void commands_fill(struct commands *commands, struct buffer *buffer, uint64_t offset_bytes,
                   uint64_t size_bytes, uint32_t word)
{
    if (!is_recording(commands) || size_bytes == 0)
        return;
    if (!fits(buffer, offset_bytes, size_bytes) || size_bytes % 4 != 0) {
        RECORDING_FAILS(commands, WHIT_ERROR_USAGE,
                        "commands \"%s\": fill of %" PRIu64 " bytes at %" PRIu64 " of buffer "
                        "\"%s\" (%" PRIu64 " bytes)",
                        commands->name, size_bytes, offset_bytes, buffer->name, buffer->size_bytes);
        return;
    }
    LAYERS_BESIDE(vkCmdFillBuffer(commands->vk, buffer->vk, offset_bytes, size_bytes, word));
}

static bool overlap(const struct buffer *a, uint64_t a_offset, const struct buffer *b,
                    uint64_t b_offset, uint64_t size_bytes)
{
    return a == b && a_offset < b_offset + size_bytes && b_offset < a_offset + size_bytes;
}

void commands_copy(struct commands *commands, struct buffer *from, uint64_t from_offset_bytes,
                   struct buffer *to, uint64_t to_offset_bytes, uint64_t size_bytes)
{
    if (!is_recording(commands) || size_bytes == 0)
        return;
    if (from_offset_bytes > from->size_bytes || size_bytes > from->size_bytes - from_offset_bytes ||
        to_offset_bytes > to->size_bytes || size_bytes > to->size_bytes - to_offset_bytes ||
        overlap(from, from_offset_bytes, to, to_offset_bytes, size_bytes)) {
        RECORDING_FAILS(commands, WHIT_ERROR_USAGE,
                        "commands \"%s\": copy of %" PRIu64 " bytes from %" PRIu64 " of buffer "
                        "\"%s\" to %" PRIu64 " of buffer \"%s\"",
                        commands->name, size_bytes, from_offset_bytes, from->name, to_offset_bytes,
                        to->name);
        return;
    }
    VkBufferCopy region = {from_offset_bytes, to_offset_bytes, size_bytes};
    LAYERS_BESIDE(vkCmdCopyBuffer(commands->vk, from->vk, to->vk, 1, &region));
}

/* Both time stamps of a span wait for all earlier work, so that spans add up to the time of the
   submission. */
static void stamp(struct commands *commands, uint32_t query)
{
    if (commands->queries)
        LAYERS_BESIDE(vkCmdWriteTimestamp(commands->vk, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT,
                                          commands->queries, query));
}

void commands_span_begin(struct commands *commands, const char *label)
{
    if (!is_recording(commands))
        return;
    if (commands->span_open || commands->span_count == COMMANDS_SPANS) {
        RECORDING_FAILS(commands, WHIT_ERROR_USAGE, "commands \"%s\": span \"%s\" is %s",
                        commands->name, label,
                        commands->span_open ? "inside another" : "one too many");
        return;
    }
    commands->span_open = true;
    if (commands->device->begin_label) {
        VkDebugUtilsLabelEXT info = {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT,
                                     .pLabelName = label};
        LAYERS_BESIDE(commands->device->begin_label(commands->vk, &info));
    }
    stamp(commands, 2 * commands->span_count);
}

void commands_span_end(struct commands *commands)
{
    if (!is_recording(commands))
        return;
    if (!commands->span_open) {
        RECORDING_FAILS(commands, WHIT_ERROR_USAGE, "commands \"%s\": end of a span never begun",
                        commands->name);
        return;
    }
    stamp(commands, 2 * commands->span_count + 1);
    if (commands->device->end_label)
        LAYERS_BESIDE(commands->device->end_label(commands->vk));
    ++commands->span_count;
    commands->span_open = false;
}

VkCommandBuffer commands_vk(const struct commands *commands)
{
    return commands->vk;
}

whit_result commands_submit_between(struct commands *commands, VkSemaphore wait, VkSemaphore signal)
{
    struct device *device = commands->device;
    whit_result result = WHIT_OK;
    if (commands->span_open)
        commands_span_end(commands);
    commands_barrier(commands); /* the host sees everything once the fence is signalled */
    if (commands->state != COMMANDS_RECORDING || commands->recording != WHIT_OK) {
        /* An unfinished recording is thrown away by the reset in commands_begin. */
        result = commands->recording;
        commands->recording = WHIT_OK;
        if (commands->state == COMMANDS_RECORDING)
            commands->state = COMMANDS_IDLE;
        return device->lost ? WHIT_ERROR_DEVICE : result;
    }
    if (device->end_label)
        LAYERS_BESIDE(device->end_label(commands->vk));
    commands->state = COMMANDS_IDLE;
    pthread_mutex_lock(&device->queue_lock);
    if (device->spreads_left > 0)
        device->spreads_left = cores_spread(device->threads) ? 0 : device->spreads_left - 1;
    VK_TRY(device, vkEndCommandBuffer(commands->vk));
    VK_TRY(device, vkResetFences(device->vk, 1, &commands->fence));
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    VkSubmitInfo info = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
        .waitSemaphoreCount = wait ? 1 : 0,
        .pWaitSemaphores = &wait,
        .pWaitDstStageMask = &stage,
        .commandBufferCount = 1,
        .pCommandBuffers = &commands->vk,
        .signalSemaphoreCount = signal ? 1 : 0,
        .pSignalSemaphores = &signal,
    };
    VK_TRY(device, vkQueueSubmit(device->queue, 1, &info, commands->fence));
    commands->state = COMMANDS_IN_FLIGHT;
fail:
    pthread_mutex_unlock(&device->queue_lock);
    return result;
}

whit_result commands_submit(struct commands *commands)
{
    return commands_submit_between(commands, VK_NULL_HANDLE, VK_NULL_HANDLE);
}

static whit_result read_spans(struct commands *commands)
{
    struct device *device = commands->device;
    whit_result result = WHIT_OK;
    uint64_t stamps[2 * COMMANDS_SPANS] = {0};
    uint32_t count = commands->span_count;
    for (uint32_t i = 0; i < count; ++i)
        commands->span_ms[i] = -1.0;
    commands->finished_span_count = count;
    if (!commands->queries || count == 0)
        return WHIT_OK;
    VK_TRY(device, vkGetQueryPoolResults(device->vk, commands->queries, 0, 2 * count, sizeof stamps,
                                         stamps, sizeof *stamps, VK_QUERY_RESULT_64_BIT));
    for (uint32_t i = 0; i < count; ++i) {
        uint64_t ticks = (stamps[2 * i + 1] - stamps[2 * i]) & device->timestamp_mask;
        commands->span_ms[i] =
            (double)ticks * (double)device->properties.limits.timestampPeriod * 1e-6;
    }
fail:
    return result;
}

whit_result commands_wait(struct commands *commands, double timeout_ms)
{
    struct device *device = commands->device;
    whit_result result = WHIT_OK;
    if (device->lost)
        return WHIT_ERROR_DEVICE;
    if (commands->state != COMMANDS_IN_FLIGHT)
        return WHIT_OK;
    uint64_t timeout_ns = UINT64_MAX;
    if (timeout_ms >= 0.0 && timeout_ms < 1e12)
        timeout_ns = (uint64_t)(timeout_ms * 1e6);
    VK_TRY(device, vkWaitForFences(device->vk, 1, &commands->fence, VK_TRUE, timeout_ns));
    commands->state = COMMANDS_IDLE;
    return read_spans(commands);
fail:
    if (result != WHIT_ERROR_TIME_LIMIT) {
        /* The caller may now destroy what these commands use, so the device must be idle. */
        pthread_mutex_lock(&device->queue_lock);
        (void)LAYERS_BESIDE(vkDeviceWaitIdle(device->vk));
        pthread_mutex_unlock(&device->queue_lock);
        commands->state = COMMANDS_IDLE;
    }
    return result;
}

whit_result commands_run(struct commands *commands)
{
    whit_result result = commands_submit(commands);
    return result == WHIT_OK ? commands_wait(commands, -1.0) : result;
}

double commands_span_ms(const struct commands *commands, uint32_t span)
{
    return span < commands->finished_span_count ? commands->span_ms[span] : -1.0;
}

uint32_t commands_span_count(const struct commands *commands)
{
    return commands->finished_span_count;
}

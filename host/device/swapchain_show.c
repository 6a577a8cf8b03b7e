/* Shows pictures in the window. One picture is in flight at a time: the host is never more than one
   picture ahead of the screen. */
#include "device/swapchain_show.h"
#include "base/clock.h"
#include "device/buffer.h"

enum { COPY_PIXELS = 4096 }; /* reordered at a time */

/* ---- The picture ---- */

whit_result swapchain_wait(struct swapchain *swapchain)
{
    struct device *device = swapchain->device;
    whit_result result = WHIT_OK;
    if (swapchain->in_flight)
        VK_TRY(device, vkWaitForFences(device->vk, 1, &swapchain->fence, VK_TRUE, UINT64_MAX));
    swapchain->in_flight = false;
fail:
    return result;
}

void swapchain_drop_canvas(struct swapchain *swapchain)
{
    vkDestroyImage(swapchain->device->vk, swapchain->canvas, NULL);
    vkFreeMemory(swapchain->device->vk, swapchain->canvas_memory, NULL);
    swapchain->canvas = VK_NULL_HANDLE;
    swapchain->canvas_memory = VK_NULL_HANDLE;
    swapchain->canvas_extent = (VkExtent2D){0};
}

static whit_result make_canvas(struct swapchain *swapchain, uint32_t width, uint32_t height)
{
    struct device *device = swapchain->device;
    whit_result result = WHIT_OK;
    VkImageCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .imageType = VK_IMAGE_TYPE_2D,
        .format = swapchain->format.format,
        .extent = {width, height, 1},
        .mipLevels = 1,
        .arrayLayers = 1,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .tiling = VK_IMAGE_TILING_OPTIMAL,
        .usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
    };
    swapchain_drop_canvas(swapchain);
    VK_TRY(device, vkCreateImage(device->vk, &info, NULL, &swapchain->canvas));
    device_name_object(device, VK_OBJECT_TYPE_IMAGE, (uint64_t)swapchain->canvas, "picture");
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device->vk, swapchain->canvas, &needs);
    uint32_t type = 0;
    while (
        type + 1 < device->memory.memoryTypeCount &&
        (!(needs.memoryTypeBits >> type & 1) ||
         !(device->memory.memoryTypes[type].propertyFlags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT)))
        ++type;
    VkMemoryAllocateInfo allocation = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
        .allocationSize = needs.size,
        .memoryTypeIndex = type,
    };
    VK_TRY(device, vkAllocateMemory(device->vk, &allocation, NULL, &swapchain->canvas_memory));
    VK_TRY(device, vkBindImageMemory(device->vk, swapchain->canvas, swapchain->canvas_memory, 0));
    swapchain->canvas_extent = (VkExtent2D){width, height};
fail:
    return result;
}

/* Writes pixels of R, G, B, A in the window's order of bytes, so that the device has only to copy
   them: a kernel that converts them takes lavapipe 18 ms in place of 4 at 1280 x 720. */
static whit_result write_pixels(const struct swapchain *swapchain, const uint8_t *rgba,
                                uint64_t count)
{
    whit_result result = WHIT_OK;
    uint8_t pixels[4 * COPY_PIXELS];
    if (!swapchain->swaps)
        return buffer_write(swapchain->picture, 0, rgba, 4 * count);
    for (uint64_t at = 0; result == WHIT_OK && at < count; at += COPY_PIXELS) {
        uint64_t part = count - at < COPY_PIXELS ? count - at : COPY_PIXELS;
        const uint8_t *from = rgba + 4 * at;
        for (uint64_t i = 0; i < 4 * part; i += 4) {
            pixels[i] = from[i + 2];
            pixels[i + 1] = from[i + 1];
            pixels[i + 2] = from[i];
            pixels[i + 3] = from[i + 3];
        }
        result = buffer_write(swapchain->picture, 4 * at, pixels, 4 * part);
    }
    return result;
}

static bool fits(const struct swapchain *swapchain)
{
    return swapchain->picture_width == swapchain->extent.width &&
           swapchain->picture_height == swapchain->extent.height;
}

whit_result swapchain_set_picture(struct swapchain *swapchain, const uint8_t *rgba, uint32_t width,
                                  uint32_t height)
{
    uint64_t bytes = (uint64_t)width * height * 4;
    whit_result result = swapchain_wait(swapchain);
    if (result == WHIT_OK && (!swapchain->picture || buffer_size(swapchain->picture) < bytes)) {
        buffer_destroy(swapchain->picture);
        swapchain->picture = NULL;
        swapchain->picture_width = swapchain->picture_height = 0;
        result = buffer_create(swapchain->device, bytes, BUFFER_HOST, "window picture",
                               &swapchain->picture);
    }
    if (result == WHIT_OK)
        result = write_pixels(swapchain, rgba, bytes / 4);
    if (result != WHIT_OK)
        return result;
    swapchain->picture_width = width;
    swapchain->picture_height = height;
    return WHIT_OK;
}

/* ---- What is recorded ---- */

static void change_layout(const struct swapchain *swapchain, VkImage image, VkImageLayout from,
                          VkImageLayout to)
{
    VkImageMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT,
        .dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT,
        .oldLayout = from,
        .newLayout = to,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1},
    };
    vkCmdPipelineBarrier(swapchain->commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                         VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, NULL, 0, NULL, 1, &barrier);
}

static void copy_picture(const struct swapchain *swapchain, VkImage image)
{
    VkBufferImageCopy copy = {
        .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
        .imageExtent = {swapchain->picture_width, swapchain->picture_height, 1}};
    change_layout(swapchain, image, VK_IMAGE_LAYOUT_UNDEFINED,
                  VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    vkCmdCopyBufferToImage(swapchain->commands, swapchain->picture->vk, image,
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
}

/* Scales the picture to the image bilinearly. */
static whit_result stretch_picture(struct swapchain *swapchain, VkImage image)
{
    VkExtent2D from = {swapchain->picture_width, swapchain->picture_height}, to = swapchain->extent,
               has = swapchain->canvas_extent;
    const VkImageSubresourceLayers layers = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    VkImageBlit blit = {
        .srcSubresource = layers,
        .srcOffsets = {{0, 0, 0}, {(int32_t)from.width, (int32_t)from.height, 1}},
        .dstSubresource = layers,
        .dstOffsets = {{0, 0, 0}, {(int32_t)to.width, (int32_t)to.height, 1}},
    };
    if (has.width != from.width || has.height != from.height) {
        whit_result result = make_canvas(swapchain, from.width, from.height);
        if (result != WHIT_OK)
            return result;
    }
    copy_picture(swapchain, swapchain->canvas);
    change_layout(swapchain, swapchain->canvas, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                  VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    change_layout(swapchain, image, VK_IMAGE_LAYOUT_UNDEFINED,
                  VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    vkCmdBlitImage(swapchain->commands, swapchain->canvas, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                   image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit, VK_FILTER_LINEAR);
    return WHIT_OK;
}

/* Leaves the image in layout COLOR_ATTACHMENT_OPTIMAL. */
static whit_result record_picture(struct swapchain *swapchain, VkImage image)
{
    VkImageLayout layout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    whit_result result = WHIT_OK;
    if (swapchain->picture_width == 0)
        layout = VK_IMAGE_LAYOUT_UNDEFINED; /* without a picture, the overlay fills the window */
    else if (fits(swapchain))
        copy_picture(swapchain, image);
    else
        result = stretch_picture(swapchain, image);
    if (result == WHIT_OK)
        change_layout(swapchain, image, layout, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    return result;
}

static void record_overlay(struct swapchain *swapchain, const struct window_image *image,
                           swapchain_draw draw, void *user)
{
    VkRenderPassBeginInfo begin = {
        .sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
        .renderPass = swapchain->pass,
        .framebuffer = image->framebuffer,
        .renderArea = {{0, 0}, swapchain->extent},
    };
    vkCmdBeginRenderPass(swapchain->commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    if (draw)
        draw(user, swapchain->commands);
    vkCmdEndRenderPass(swapchain->commands);
}

/* Expects the image in layout COLOR_ATTACHMENT_OPTIMAL, and leaves it in *layout. */
static whit_result record_capture(struct swapchain *swapchain, const struct window_image *image,
                                  VkImageLayout *layout)
{
    VkExtent2D extent = swapchain->extent;
    uint64_t bytes = (uint64_t)extent.width * extent.height * 4;
    whit_result result = WHIT_OK;
    *layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    if (!swapchain->captures)
        return WHIT_OK;
    if (!swapchain->capture || buffer_size(swapchain->capture) < bytes) {
        buffer_destroy(swapchain->capture);
        result = buffer_create(swapchain->device, bytes, BUFFER_HOST, "window copy",
                               &swapchain->capture);
    }
    if (result != WHIT_OK)
        return result;
    VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                              .imageExtent = {extent.width, extent.height, 1}};
    change_layout(swapchain, image->image, *layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    vkCmdCopyImageToBuffer(swapchain->commands, image->image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                           swapchain->capture->vk, 1, &copy);
    *layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    return WHIT_OK;
}

static void stamp(struct swapchain *swapchain, uint32_t query)
{
    if (swapchain->queries)
        vkCmdWriteTimestamp(swapchain->commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT,
                            swapchain->queries, query);
}

static whit_result begin_commands(struct swapchain *swapchain)
{
    struct device *device = swapchain->device;
    whit_result result = WHIT_OK;
    VkCommandBufferBeginInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
        .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
    };
    VK_TRY(device, vkResetCommandPool(device->vk, swapchain->pool, 0));
    VK_TRY(device, vkBeginCommandBuffer(swapchain->commands, &info));
fail:
    return result;
}

static whit_result record(struct swapchain *swapchain, uint32_t index, swapchain_draw draw,
                          void *user, bool capture)
{
    struct device *device = swapchain->device;
    const struct window_image *image = &swapchain->images[index];
    VkImageLayout layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    whit_result result = begin_commands(swapchain);
    if (result != WHIT_OK)
        return result;
    if (swapchain->queries)
        vkCmdResetQueryPool(swapchain->commands, swapchain->queries, 0, 2);
    stamp(swapchain, 0);
    result = record_picture(swapchain, image->image);
    if (result != WHIT_OK)
        return result;
    record_overlay(swapchain, image, draw, user);
    if (capture)
        result = record_capture(swapchain, image, &layout);
    change_layout(swapchain, image->image, layout, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
    stamp(swapchain, 1);
    if (result == WHIT_OK)
        VK_TRY(device, vkEndCommandBuffer(swapchain->commands));
fail:
    return result;
}

static whit_result submit(struct swapchain *swapchain, VkSemaphore wait, VkSemaphore signal)
{
    struct device *device = swapchain->device;
    whit_result result = WHIT_OK;
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    VkSubmitInfo info = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
        .waitSemaphoreCount = wait ? 1 : 0,
        .pWaitSemaphores = &wait,
        .pWaitDstStageMask = &stage,
        .commandBufferCount = 1,
        .pCommandBuffers = &swapchain->commands,
        .signalSemaphoreCount = signal ? 1 : 0,
        .pSignalSemaphores = &signal,
    };
    VK_TRY(device, vkResetFences(device->vk, 1, &swapchain->fence));
    VK_TRY(device, vkQueueSubmit(device->queue, 1, &info, swapchain->fence));
    swapchain->in_flight = true;
fail:
    return result;
}

/* ---- Showing ---- */

/* Suboptimal and out-of-date are no errors: *usable and swapchain->stale report them. */
static whit_result window_result(struct swapchain *swapchain, VkResult vk, const char *call,
                                 bool *usable)
{
    *usable = vk >= 0 && vk != VK_NOT_READY && vk != VK_TIMEOUT;
    if (vk == VK_SUBOPTIMAL_KHR || vk == VK_ERROR_OUT_OF_DATE_KHR)
        swapchain->stale = true;
    if (vk == VK_ERROR_OUT_OF_DATE_KHR)
        return WHIT_OK;
    return device_check(swapchain->device, vk, call, __FILE__, __LINE__);
}

static whit_result acquire(struct swapchain *swapchain, uint32_t *index, bool *usable)
{
    struct device *device = swapchain->device;
    VkResult vk = VK_SUCCESS;
    if (device_may_call(device, "vkAcquireNextImageKHR", &vk)) {
        VkResult instead = vk;
        vk = vkAcquireNextImageKHR(device->vk, swapchain->vk, UINT64_MAX, swapchain->acquired,
                                   VK_NULL_HANDLE, index);
        vk = vk == VK_SUCCESS ? instead : vk;
    }
    return window_result(swapchain, vk, "vkAcquireNextImageKHR", usable);
}

static whit_result present(struct swapchain *swapchain, uint32_t index, bool *shown)
{
    struct device *device = swapchain->device;
    VkPresentInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
        .waitSemaphoreCount = 1,
        .pWaitSemaphores = &swapchain->images[index].drawn,
        .swapchainCount = 1,
        .pSwapchains = &swapchain->vk,
        .pImageIndices = &index,
    };
    VkResult vk = VK_SUCCESS;
    double start_ms = clock_ms();
    if (device_may_call(device, "vkQueuePresentKHR", &vk)) {
        VkResult instead = vk;
        vk = vkQueuePresentKHR(device->queue, &info);
        vk = vk == VK_SUCCESS ? instead : vk;
    }
    swapchain->info.present_ms = clock_ms() - start_ms;
    return window_result(swapchain, vk, "vkQueuePresentKHR", shown);
}

static void read_time(struct swapchain *swapchain)
{
    const struct device *device = swapchain->device;
    uint64_t stamps[2] = {0};
    swapchain->info.draw_ms = -1.0;
    if (!swapchain->queries ||
        vkGetQueryPoolResults(device->vk, swapchain->queries, 0, 2, sizeof stamps, stamps,
                              sizeof *stamps, VK_QUERY_RESULT_64_BIT) != VK_SUCCESS)
        return;
    uint64_t ticks = (stamps[1] - stamps[0]) & device->timestamp_mask;
    swapchain->info.draw_ms =
        (double)ticks * (double)device->properties.limits.timestampPeriod * 1e-6;
}

static whit_result show(struct swapchain *swapchain, swapchain_draw draw, void *user, bool capture,
                        bool *shown)
{
    double start_ms = clock_ms();
    bool usable = false;
    uint32_t index = 0;
    *shown = false;
    bool had_one = swapchain->in_flight;
    whit_result result = swapchain_wait(swapchain);
    if (result != WHIT_OK || swapchain->extent.width == 0)
        return result;
    if (had_one)
        read_time(swapchain);
    if (swapchain->stale)
        return WHIT_OK; /* nothing is shown until the caller has called swapchain_resize */
    result = acquire(swapchain, &index, &usable);
    swapchain->info.wait_ms = clock_ms() - start_ms;
    if (result != WHIT_OK || !usable)
        return result;
    result = record(swapchain, index, draw, user, capture);
    if (result == WHIT_OK)
        result = submit(swapchain, swapchain->acquired, swapchain->images[index].drawn);
    return result == WHIT_OK ? present(swapchain, index, shown) : result;
}

whit_result swapchain_show(struct swapchain *swapchain, swapchain_draw draw, void *user,
                           bool *shown)
{
    swapchain->captured = false;
    return show(swapchain, draw, user, false, shown);
}

whit_result swapchain_show_and_keep(struct swapchain *swapchain, swapchain_draw draw, void *user,
                                    bool *shown)
{
    whit_result result = show(swapchain, draw, user, true, shown);
    swapchain->captured = result == WHIT_OK && *shown && swapchain->captures;
    return result;
}

whit_result swapchain_read(struct swapchain *swapchain, uint8_t *rgba, size_t bytes)
{
    size_t needed = (size_t)swapchain->extent.width * swapchain->extent.height * 4;
    whit_result result = swapchain_wait(swapchain);
    if (result != WHIT_OK)
        return result;
    if (!swapchain->captured || bytes < needed) {
        log_error(&swapchain->device->log, "no copy of the window was kept");
        return WHIT_ERROR_USAGE;
    }
    result = buffer_read(swapchain->capture, 0, rgba, needed);
    bool swapped = swapchain->format.format == VK_FORMAT_B8G8R8A8_UNORM;
    for (size_t i = 0; swapped && i < needed; i += 4) {
        uint8_t blue = rgba[i];
        rgba[i] = rgba[i + 2];
        rgba[i + 2] = blue;
    }
    return result;
}

whit_result swapchain_submit(struct swapchain *swapchain, void (*fn)(void *user, void *commands),
                             void *user)
{
    struct device *device = swapchain->device;
    whit_result result = swapchain_wait(swapchain);
    if (result == WHIT_OK)
        result = begin_commands(swapchain);
    if (result != WHIT_OK)
        return result;
    fn(user, swapchain->commands);
    VK_TRY(device, vkEndCommandBuffer(swapchain->commands));
    result = submit(swapchain, VK_NULL_HANDLE, VK_NULL_HANDLE);
    if (result == WHIT_OK)
        result = swapchain_wait(swapchain);
fail:
    return result;
}

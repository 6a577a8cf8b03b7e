/* Shows pictures in the window. One picture is in flight at a time: the host is never more than one
   picture ahead of the screen. */
#include "device/swapchain_inside.h"

#include <stdlib.h>

#include "base/array.h"
#include "base/clock.h"
#include "device/buffer.h"
#include "device/commands_private.h"
#include "device/stretch.h"

enum { COPY_PIXELS = 4096 }; /* reordered at a time */
static const VkClearColorValue DARK = {{0.06f, 0.08f, 0.10f, 1.0f}};

/* ---- The picture ---- */

whit_result swapchain_wait(struct swapchain *swapchain)
{
    whit_result result = commands_wait(swapchain->commands, -1.0);
    if (commands_span_count(swapchain->commands) > 0)
        swapchain->info.draw_ms = commands_span_ms(swapchain->commands, 0);
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

/* Writes the picture at the size of the window. By the device, lavapipe takes 4 times as long, and
   some 40 ms to compile the code when the first picture is shown. */
static whit_result write_stretched(const struct swapchain *swapchain, const uint8_t *rgba,
                                   uint32_t width, uint32_t height)
{
    const struct stretch stretch = {.from = rgba,
                                    .from_width = width,
                                    .from_height = height,
                                    .width = swapchain->extent.width,
                                    .height = swapchain->extent.height,
                                    .swaps = swapchain->swaps};
    uint64_t row_bytes = (uint64_t)stretch.width * sizeof(uint32_t);
    uint32_t *row = array_alloc(stretch.width, sizeof *row);
    void *scratch = array_alloc(stretch_scratch_bytes(&stretch), 1);
    whit_result result = WHIT_OK;
    if (row && scratch) {
        stretch_begin(&stretch, scratch);
        for (uint32_t y = 0; y < stretch.height && result == WHIT_OK; ++y) {
            stretch_row(&stretch, scratch, y, row);
            result = buffer_write(swapchain->picture, y * row_bytes, row, row_bytes);
        }
    } else {
        result = log_failure(&swapchain->device->log, WHIT_ERROR_MEMORY,
                             "out of memory for the window's picture");
    }
    free(scratch);
    free(row);
    return result;
}

whit_result swapchain_set_picture(struct swapchain *swapchain, const uint8_t *rgba, uint32_t width,
                                  uint32_t height)
{
    VkExtent2D extent = swapchain->extent;
    uint64_t bytes = (uint64_t)extent.width * extent.height * 4;
    bool fits = width == extent.width && height == extent.height;
    whit_result result = swapchain_wait(swapchain);
    swapchain->has_picture = false;
    if (bytes == 0 || result != WHIT_OK)
        return result;
    if (!swapchain->picture || buffer_size(swapchain->picture) < bytes) {
        buffer_destroy(swapchain->picture);
        swapchain->picture = NULL;
        result = buffer_create(swapchain->device, bytes, BUFFER_HOST, "window picture",
                               &swapchain->picture);
    }
    if (result == WHIT_OK)
        result = fits ? write_pixels(swapchain, rgba, bytes / 4)
                      : write_stretched(swapchain, rgba, width, height);
    swapchain->has_picture = result == WHIT_OK;
    return result;
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
    LAYERS_BESIDE(
        vkCmdPipelineBarrier(commands_vk(swapchain->commands), VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                             VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, NULL, 0, NULL, 1, &barrier));
}

/* Copies the picture; without one the window is dark. Leaves the image in layout
   COLOR_ATTACHMENT_OPTIMAL. */
static void record_picture(const struct swapchain *swapchain, VkImage image)
{
    const VkImageLayout layout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    const VkBufferImageCopy copy = {
        .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
        .imageExtent = {swapchain->extent.width, swapchain->extent.height, 1}};
    const VkImageSubresourceRange all = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    change_layout(swapchain, image, VK_IMAGE_LAYOUT_UNDEFINED, layout);
    if (swapchain->has_picture)
        LAYERS_BESIDE(vkCmdCopyBufferToImage(commands_vk(swapchain->commands),
                                             swapchain->picture->vk, image, layout, 1, &copy));
    else
        LAYERS_BESIDE(
            vkCmdClearColorImage(commands_vk(swapchain->commands), image, layout, &DARK, 1, &all));
    change_layout(swapchain, image, layout, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
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
    LAYERS_BESIDE(
        vkCmdBeginRenderPass(commands_vk(swapchain->commands), &begin, VK_SUBPASS_CONTENTS_INLINE));
    if (draw)
        draw(user, commands_vk(swapchain->commands));
    LAYERS_BESIDE(vkCmdEndRenderPass(commands_vk(swapchain->commands)));
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
    LAYERS_BESIDE(vkCmdCopyImageToBuffer(commands_vk(swapchain->commands), image->image,
                                         VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                         swapchain->capture->vk, 1, &copy));
    *layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    return WHIT_OK;
}

static whit_result record(struct swapchain *swapchain, uint32_t index, swapchain_draw draw,
                          void *user, bool capture)
{
    const struct window_image *image = &swapchain->images[index];
    VkImageLayout layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    whit_result result = commands_begin(swapchain->commands);
    if (result != WHIT_OK)
        return result;
    commands_span_begin(swapchain->commands, "show");
    record_picture(swapchain, image->image);
    record_overlay(swapchain, image, draw, user);
    if (capture)
        result = record_capture(swapchain, image, &layout);
    change_layout(swapchain, image->image, layout, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
    commands_span_end(swapchain->commands);
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
        vk = LAYERS_BESIDE(vkAcquireNextImageKHR(device->vk, swapchain->vk, UINT64_MAX,
                                                 swapchain->acquired, VK_NULL_HANDLE, index));
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
        vk = LAYERS_BESIDE(vkQueuePresentKHR(device->queue, &info));
        vk = vk == VK_SUCCESS ? instead : vk;
    }
    swapchain->info.present_ms = clock_ms() - start_ms;
    return window_result(swapchain, vk, "vkQueuePresentKHR", shown);
}

whit_result swapchain_show(struct swapchain *swapchain, swapchain_draw draw, void *user, bool keep,
                           bool *shown)
{
    double start_ms = clock_ms();
    bool usable = false;
    uint32_t index = 0;
    *shown = swapchain->captured = false;
    whit_result result = swapchain_wait(swapchain);
    if (result != WHIT_OK || swapchain->extent.width == 0)
        return result;
    if (swapchain->stale)
        return WHIT_OK; /* nothing is shown until the caller has called swapchain_resize */
    result = acquire(swapchain, &index, &usable);
    swapchain->info.wait_ms = clock_ms() - start_ms;
    if (result != WHIT_OK || !usable)
        return result;
    result = record(swapchain, index, draw, user, keep);
    if (result == WHIT_OK)
        result = commands_submit_between(swapchain->commands, swapchain->acquired,
                                         swapchain->images[index].drawn);
    if (result == WHIT_OK)
        result = present(swapchain, index, shown);
    swapchain->captured = keep && result == WHIT_OK && *shown && swapchain->captures;
    return result;
}

whit_result swapchain_read(struct swapchain *swapchain, uint8_t *rgba, size_t bytes)
{
    size_t needed = (size_t)swapchain->extent.width * swapchain->extent.height * 4;
    whit_result result = swapchain_wait(swapchain);
    if (result != WHIT_OK)
        return result;
    if (!swapchain->captured || bytes < needed)
        return log_usage(&swapchain->device->log, "no copy of the window was kept");
    result = buffer_read(swapchain->capture, 0, rgba, needed);
    for (size_t i = 0; swapchain->swaps && i < needed; i += 4) {
        uint8_t blue = rgba[i];
        rgba[i] = rgba[i + 2];
        rgba[i + 2] = blue;
    }
    return result;
}

whit_result swapchain_submit(struct swapchain *swapchain, void (*fn)(void *user, void *commands),
                             void *user)
{
    whit_result result = swapchain_wait(swapchain);
    if (result == WHIT_OK)
        result = commands_begin(swapchain->commands);
    if (result != WHIT_OK)
        return result;
    fn(user, commands_vk(swapchain->commands));
    result = commands_submit(swapchain->commands);
    return result == WHIT_OK ? swapchain_wait(swapchain) : result;
}

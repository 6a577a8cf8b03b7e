/* Creates and destroys the window's images and what is needed to draw on them; swapchain_show.c
   shows pictures. */
#include <stdlib.h>

#include "base/array.h"
#include "device/buffer.h"
#include "device/commands.h"
#include "device/swapchain_inside.h"

static const struct known_format {
    VkFormat format;
    const char *name;
    bool swaps;
} known_formats[] = {
    {VK_FORMAT_B8G8R8A8_UNORM, "B8G8R8A8", true},
    {VK_FORMAT_R8G8B8A8_UNORM, "R8G8B8A8", false},
    {VK_FORMAT_A8B8G8R8_UNORM_PACK32, "A8B8G8R8", false},
};
enum { KNOWN_FORMATS = sizeof known_formats / sizeof *known_formats };

/* ---- What does not depend on the size ---- */

static whit_result choose_format(struct swapchain *swapchain)
{
    struct device *device = swapchain->device;
    VkSurfaceFormatKHR formats[64];
    uint32_t count = sizeof formats / sizeof *formats;
    VkSurfaceCapabilitiesKHR can;
    whit_result result = WHIT_OK;
    VK_TRY(device, vkGetPhysicalDeviceSurfaceFormatsKHR(device->physical, device->surface, &count,
                                                        formats));
    VK_TRY(device,
           vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device->physical, device->surface, &can));
    for (int known = 0; known < KNOWN_FORMATS; ++known) {
        for (uint32_t i = 0; i < count && !swapchain->info.format; ++i) {
            if (formats[i].format != known_formats[known].format ||
                formats[i].colorSpace != VK_COLOR_SPACE_SRGB_NONLINEAR_KHR)
                continue;
            swapchain->format = formats[i];
            swapchain->info.format = known_formats[known].name;
            swapchain->swaps = known_formats[known].swaps;
        }
    }
    if (!swapchain->info.format)
        return log_failure(&device->log, WHIT_ERROR_NO_DEVICE,
                           "the window takes no 8-bit format that whit knows");
    swapchain->captures = (can.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_SRC_BIT) != 0;
    if (!(can.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_DST_BIT))
        result = log_failure(&device->log, WHIT_ERROR_NO_DEVICE,
                             "the window's images cannot be copied to");
fail:
    return result;
}

static whit_result make_pass(struct swapchain *swapchain)
{
    struct device *device = swapchain->device;
    whit_result result = WHIT_OK;
    VkAttachmentDescription attachment = {
        .format = swapchain->format.format,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .loadOp = VK_ATTACHMENT_LOAD_OP_LOAD,
        .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
        .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
        .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
        .initialLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
        .finalLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
    };
    VkAttachmentReference color = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass = {
        .pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
        .colorAttachmentCount = 1,
        .pColorAttachments = &color,
    };
    VkRenderPassCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
        .attachmentCount = 1,
        .pAttachments = &attachment,
        .subpassCount = 1,
        .pSubpasses = &subpass,
    };
    VK_TRY(device, vkCreateRenderPass(device->vk, &info, NULL, &swapchain->pass));
    device_name_object(device, VK_OBJECT_TYPE_RENDER_PASS, (uint64_t)swapchain->pass, "overlay");
fail:
    return result;
}

static whit_result make_semaphore(struct device *device, const char *name, VkSemaphore *out)
{
    VkSemaphoreCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    whit_result result = WHIT_OK;
    VK_TRY(device, vkCreateSemaphore(device->vk, &info, NULL, out));
    device_name_object(device, VK_OBJECT_TYPE_SEMAPHORE, (uint64_t)*out, name);
fail:
    return result;
}

whit_result swapchain_create(struct device *device, const struct swapchain_params *params,
                             struct swapchain **out)
{
    *out = NULL;
    struct swapchain *swapchain = array_alloc_zeroed(1, sizeof *swapchain);
    if (!swapchain)
        return log_failure(&device->log, WHIT_ERROR_MEMORY, "out of memory for a window");
    swapchain->device = device;
    swapchain->vsync = params->vsync;
    swapchain->info.draw_ms = -1.0;
    whit_result result = choose_format(swapchain);
    if (result == WHIT_OK)
        result = commands_create(device, "window", &swapchain->commands);
    if (result == WHIT_OK)
        result = make_semaphore(device, "image acquired", &swapchain->acquired);
    if (result == WHIT_OK)
        result = make_pass(swapchain);
    if (result != WHIT_OK) {
        swapchain_destroy(swapchain);
        return result;
    }
    *out = swapchain;
    return WHIT_OK;
}

/* ---- The window's images ---- */

static void drop_views(struct swapchain *swapchain)
{
    VkDevice vk = swapchain->device->vk;
    for (uint32_t i = 0; i < swapchain->image_count; ++i) {
        struct window_image *image = &swapchain->images[i];
        LAYERS_BESIDE(vkDestroyFramebuffer(vk, image->framebuffer, NULL));
        LAYERS_BESIDE(vkDestroyImageView(vk, image->view, NULL));
        LAYERS_BESIDE(vkDestroySemaphore(vk, image->drawn, NULL));
        *image = (struct window_image){0};
    }
    swapchain->image_count = 0;
}

void swapchain_destroy(struct swapchain *swapchain)
{
    if (!swapchain)
        return;
    VkDevice vk = swapchain->device->vk;
    (void)LAYERS_BESIDE(vkDeviceWaitIdle(vk)); /* fails for a lost device, which has no work left */
    drop_views(swapchain);
    buffer_destroy(swapchain->picture);
    buffer_destroy(swapchain->capture);
    LAYERS_BESIDE(vkDestroySwapchainKHR(vk, swapchain->vk, NULL));
    LAYERS_BESIDE(vkDestroyRenderPass(vk, swapchain->pass, NULL));
    LAYERS_BESIDE(vkDestroySemaphore(vk, swapchain->acquired, NULL));
    commands_destroy(swapchain->commands);
    free(swapchain);
}

static VkPresentModeKHR choose_mode(const struct swapchain *swapchain)
{
    VkPresentModeKHR modes[16];
    uint32_t count = sizeof modes / sizeof *modes;
    VkPresentModeKHR best = VK_PRESENT_MODE_FIFO_KHR; /* Vulkan promises this one */
    if (swapchain->vsync ||
        LAYERS_BESIDE(vkGetPhysicalDeviceSurfacePresentModesKHR(
            swapchain->device->physical, swapchain->device->surface, &count, modes)) < 0)
        return best;
    for (uint32_t i = 0; i < count; ++i) {
        if (modes[i] == VK_PRESENT_MODE_IMMEDIATE_KHR)
            return modes[i];
        if (modes[i] == VK_PRESENT_MODE_MAILBOX_KHR)
            best = modes[i];
    }
    return best;
}

static uint32_t clamp(uint32_t value, uint32_t lo, uint32_t hi)
{
    return value < lo ? lo : value > hi ? hi : value;
}

/* Sets swapchain->extent; 0 x 0 where the window has no place for a picture. */
static whit_result make_chain(struct swapchain *swapchain, uint32_t width, uint32_t height)
{
    struct device *device = swapchain->device;
    VkSwapchainKHR old = swapchain->vk;
    VkSurfaceCapabilitiesKHR can;
    whit_result result = WHIT_OK;
    swapchain->extent = (VkExtent2D){0};
    VK_TRY(device,
           vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device->physical, device->surface, &can));
    VkExtent2D extent = can.currentExtent;
    if (extent.width == UINT32_MAX) {
        extent.width = clamp(width, can.minImageExtent.width, can.maxImageExtent.width);
        extent.height = clamp(height, can.minImageExtent.height, can.maxImageExtent.height);
    }
    if (width == 0 || height == 0 || extent.width == 0 || extent.height == 0)
        return WHIT_OK;
    uint32_t max = can.maxImageCount ? can.maxImageCount : IMAGES_MAX;
    VkSwapchainCreateInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
        .surface = device->surface,
        .minImageCount = clamp(can.minImageCount, 2, max),
        .imageFormat = swapchain->format.format,
        .imageColorSpace = swapchain->format.colorSpace,
        .imageExtent = extent,
        .imageArrayLayers = 1,
        .imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                      (swapchain->captures ? VK_IMAGE_USAGE_TRANSFER_SRC_BIT : 0u),
        .imageSharingMode = VK_SHARING_MODE_EXCLUSIVE,
        .preTransform = can.currentTransform,
        .compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR,
        .presentMode = choose_mode(swapchain),
        .clipped = VK_FALSE, /* pictures are read back */
        .oldSwapchain = old,
    };
    swapchain->vk = VK_NULL_HANDLE;
    VK_TRY(device, vkCreateSwapchainKHR(device->vk, &info, NULL, &swapchain->vk));
    device_name_object(device, VK_OBJECT_TYPE_SWAPCHAIN_KHR, (uint64_t)swapchain->vk, "window");
    swapchain->extent = extent;
    ++swapchain->info.recreated;
fail:
    if (old && old != swapchain->vk)
        LAYERS_BESIDE(vkDestroySwapchainKHR(device->vk, old, NULL));
    return result;
}

static whit_result make_view(struct swapchain *swapchain, struct window_image *image)
{
    struct device *device = swapchain->device;
    whit_result result = WHIT_OK;
    VkImageViewCreateInfo view = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = image->image,
        .viewType = VK_IMAGE_VIEW_TYPE_2D,
        .format = swapchain->format.format,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1},
    };
    VkFramebufferCreateInfo framebuffer = {
        .sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
        .renderPass = swapchain->pass,
        .attachmentCount = 1,
        .pAttachments = &image->view,
        .width = swapchain->extent.width,
        .height = swapchain->extent.height,
        .layers = 1,
    };
    device_name_object(device, VK_OBJECT_TYPE_IMAGE, (uint64_t)image->image, "window image");
    VK_TRY(device, vkCreateImageView(device->vk, &view, NULL, &image->view));
    VK_TRY(device, vkCreateFramebuffer(device->vk, &framebuffer, NULL, &image->framebuffer));
    result = make_semaphore(device, "picture drawn", &image->drawn);
fail:
    return result;
}

static whit_result make_views(struct swapchain *swapchain)
{
    struct device *device = swapchain->device;
    VkImage images[IMAGES_MAX];
    uint32_t count = 0;
    whit_result result = WHIT_OK;
    VK_TRY(device, vkGetSwapchainImagesKHR(device->vk, swapchain->vk, &count, NULL));
    if (count > IMAGES_MAX)
        return log_failure(&device->log, WHIT_ERROR_DEVICE,
                           "the window wants %u images; whit keeps %d at most", count, IMAGES_MAX);
    VK_TRY(device, vkGetSwapchainImagesKHR(device->vk, swapchain->vk, &count, images));
    swapchain->image_count = count;
    for (uint32_t i = 0; result == WHIT_OK && i < count; ++i) {
        swapchain->images[i].image = images[i];
        result = make_view(swapchain, &swapchain->images[i]);
    }
fail:
    return result;
}

whit_result swapchain_resize(struct swapchain *swapchain, uint32_t width, uint32_t height)
{
    struct device *device = swapchain->device;
    whit_result result = swapchain_wait(swapchain);
    if (result != WHIT_OK)
        return result;
    VK_TRY(device, vkQueueWaitIdle(device->queue)); /* the last present may still use semaphores */
    drop_views(swapchain);
    swapchain->has_picture = false;
    swapchain->captured = false;
    swapchain->stale = false;
    result = make_chain(swapchain, width, height);
    if (result == WHIT_OK && swapchain->extent.width > 0)
        result = make_views(swapchain);
    if (result != WHIT_OK)
        swapchain->extent = (VkExtent2D){0};
fail:
    return result;
}

void swapchain_get_info(const struct swapchain *swapchain, struct swapchain_info *info)
{
    *info = swapchain->info;
    info->width = swapchain->extent.width;
    info->height = swapchain->extent.height;
    info->image_count = swapchain->image_count;
    info->stale = swapchain->stale;
}

void swapchain_get_handles(const struct swapchain *swapchain, struct swapchain_handles *handles)
{
    const struct device *device = swapchain->device;
    *handles = (struct swapchain_handles){
        .instance = device->instance,
        .physical = device->physical,
        .device = device->vk,
        .queue = device->queue,
        .render_pass = (uint64_t)swapchain->pass,
        .pipeline_cache = (uint64_t)device->cache,
        .queue_family = device->queue_family,
        .image_count = swapchain->image_count < 2 ? 2 : swapchain->image_count,
    };
}

whit_result swapchain_failed(struct swapchain *swapchain, int vk, const char *of_what)
{
    swapchain->device->abandoned = true;
    return device_check(swapchain->device, (VkResult)vk, of_what, __FILE__, __LINE__);
}

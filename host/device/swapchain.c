/* The window's images and the way of a picture onto them. One picture is in flight at a time: the
   host is never more than one ahead of the screen. */
#include "device/swapchain.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/clock.h"
#include "device/vulkan.h"

enum { IMAGES_MOST = 8, PRESENT_GROUP = 8 };

struct window_image {
    VkImage image;
    VkImageView view;
    VkFramebuffer framebuffer;
    VkSemaphore drawn;
    VkDescriptorSet set; /* direct only */
};

struct swapchain {
    struct device *device;
    bool direct, vsync, captures, captured, in_flight, stale;
    VkSurfaceFormatKHR format;
    VkExtent2D extent; /* 0 x 0: no images */
    VkSwapchainKHR vk;
    uint32_t image_count;
    struct window_image images[IMAGES_MOST];

    VkCommandPool pool;
    VkCommandBuffer commands;
    VkFence fence;
    VkSemaphore acquired;
    VkQueryPool queries; /* null without timestamps */
    VkRenderPass pass;

    VkDescriptorSetLayout set_layout; /* these four: direct only */
    VkPipelineLayout layout;
    VkPipeline pipeline;
    VkDescriptorPool descriptors;

    struct buffer *picture; /* RGBA bytes, of the host */
    uint32_t picture_width, picture_height;
    VkImage canvas; /* the picture, where it is blitted: not direct */
    VkDeviceMemory canvas_memory;
    VkExtent2D canvas_extent;
    struct buffer *capture;
    struct swapchain_info info;
};

struct present_push {
    uint32_t picture_width, picture_height, window_width, window_height;
};

static const struct known_format {
    VkFormat format;
    const char *name;
} known_formats[] = {
    {VK_FORMAT_B8G8R8A8_UNORM, "B8G8R8A8"},
    {VK_FORMAT_R8G8B8A8_UNORM, "R8G8B8A8"},
    {VK_FORMAT_A8B8G8R8_UNORM_PACK32, "A8B8G8R8"},
};
enum { KNOWN_FORMATS = sizeof known_formats / sizeof *known_formats };

/* ---- What does not depend on the size ---- */

static bool can_store(const struct swapchain *swapchain, VkImageUsageFlags usage)
{
    VkFormatProperties properties;
    vkGetPhysicalDeviceFormatProperties(swapchain->device->physical, swapchain->format.format,
                                        &properties);
    return (usage & VK_IMAGE_USAGE_STORAGE_BIT) && swapchain->device->writes_any_format &&
           (properties.optimalTilingFeatures & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT);
}

static whit_result choose_format(struct swapchain *swapchain, bool blit)
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
        }
    }
    if (!swapchain->info.format) {
        log_error(&device->log, "the window takes no 8-bit format that whit knows");
        return WHIT_ERROR_NO_DEVICE;
    }
    swapchain->direct = !blit && can_store(swapchain, can.supportedUsageFlags);
    swapchain->captures = (can.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_SRC_BIT) != 0;
    if (!swapchain->direct && !(can.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_DST_BIT)) {
        log_error(&device->log, "the window's images can be neither written nor copied to");
        result = WHIT_ERROR_NO_DEVICE;
    }
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

static whit_result make_commands(struct swapchain *swapchain)
{
    struct device *device = swapchain->device;
    whit_result result = WHIT_OK;
    VkCommandPoolCreateInfo pool = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
        .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
        .queueFamilyIndex = device->queue_family,
    };
    VkCommandBufferAllocateInfo buffer = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
        .commandBufferCount = 1,
    };
    VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    VkQueryPoolCreateInfo queries = {
        .sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
        .queryType = VK_QUERY_TYPE_TIMESTAMP,
        .queryCount = 2,
    };
    VK_TRY(device, vkCreateCommandPool(device->vk, &pool, NULL, &swapchain->pool));
    buffer.commandPool = swapchain->pool;
    VK_TRY(device, vkAllocateCommandBuffers(device->vk, &buffer, &swapchain->commands));
    VK_TRY(device, vkCreateFence(device->vk, &fence, NULL, &swapchain->fence));
    if (device->timestamp_mask != 0)
        VK_TRY(device, vkCreateQueryPool(device->vk, &queries, NULL, &swapchain->queries));
    device_name_object(device, VK_OBJECT_TYPE_COMMAND_BUFFER, (uint64_t)swapchain->commands,
                       "window");
    device_name_object(device, VK_OBJECT_TYPE_FENCE, (uint64_t)swapchain->fence, "window");
    result = make_semaphore(device, "image acquired", &swapchain->acquired);
fail:
    return result;
}

static whit_result make_layouts(struct swapchain *swapchain)
{
    struct device *device = swapchain->device;
    whit_result result = WHIT_OK;
    const VkDescriptorSetLayoutBinding bindings[] = {
        {0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, NULL},
        {1, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1, VK_SHADER_STAGE_COMPUTE_BIT, NULL},
    };
    VkDescriptorSetLayoutCreateInfo set_layout = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = 2,
        .pBindings = bindings,
    };
    VkPushConstantRange range = {VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(struct present_push)};
    VkPipelineLayoutCreateInfo layout = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .setLayoutCount = 1,
        .pushConstantRangeCount = 1,
        .pPushConstantRanges = &range,
    };
    const VkDescriptorPoolSize sizes[] = {
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, IMAGES_MOST},
        {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, IMAGES_MOST},
    };
    VkDescriptorPoolCreateInfo pool = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
        .maxSets = IMAGES_MOST,
        .poolSizeCount = 2,
        .pPoolSizes = sizes,
    };
    VK_TRY(device,
           vkCreateDescriptorSetLayout(device->vk, &set_layout, NULL, &swapchain->set_layout));
    layout.pSetLayouts = &swapchain->set_layout;
    VK_TRY(device, vkCreatePipelineLayout(device->vk, &layout, NULL, &swapchain->layout));
    VK_TRY(device, vkCreateDescriptorPool(device->vk, &pool, NULL, &swapchain->descriptors));
fail:
    return result;
}

static whit_result make_pipeline(struct swapchain *swapchain, const struct swapchain_params *params)
{
    struct device *device = swapchain->device;
    VkShaderModule module = VK_NULL_HANDLE;
    whit_result result = make_layouts(swapchain);
    if (result != WHIT_OK)
        return result;
    VkShaderModuleCreateInfo code = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
        .codeSize = params->spirv_bytes,
        .pCode = params->spirv,
    };
    VkComputePipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .pName = "main"},
        .layout = swapchain->layout,
    };
    VK_TRY(device, vkCreateShaderModule(device->vk, &code, NULL, &module));
    info.stage.module = module;
    VK_TRY(device, vkCreateComputePipelines(device->vk, device->cache, 1, &info, NULL,
                                            &swapchain->pipeline));
    device_name_object(device, VK_OBJECT_TYPE_PIPELINE, (uint64_t)swapchain->pipeline, "present");
fail:
    vkDestroyShaderModule(device->vk, module, NULL);
    return result;
}

whit_result swapchain_create(struct device *device, const struct swapchain_params *params,
                             struct swapchain **out)
{
    *out = NULL;
    struct swapchain *swapchain = array_alloc_zeroed(1, sizeof *swapchain);
    if (!swapchain) {
        log_error(&device->log, "out of memory for a window");
        return WHIT_ERROR_MEMORY;
    }
    swapchain->device = device;
    swapchain->vsync = params->vsync;
    swapchain->info.draw_ms = -1.0;
    whit_result result = choose_format(swapchain, params->blit);
    if (result == WHIT_OK)
        result = make_commands(swapchain);
    if (result == WHIT_OK)
        result = make_pass(swapchain);
    if (result == WHIT_OK && swapchain->direct)
        result = make_pipeline(swapchain, params);
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
        vkDestroyFramebuffer(vk, image->framebuffer, NULL);
        vkDestroyImageView(vk, image->view, NULL);
        vkDestroySemaphore(vk, image->drawn, NULL);
        *image = (struct window_image){0};
    }
    swapchain->image_count = 0;
    if (swapchain->descriptors)
        (void)vkResetDescriptorPool(vk, swapchain->descriptors, 0); /* always succeeds */
}

static void drop_canvas(struct swapchain *swapchain)
{
    vkDestroyImage(swapchain->device->vk, swapchain->canvas, NULL);
    vkFreeMemory(swapchain->device->vk, swapchain->canvas_memory, NULL);
    swapchain->canvas = VK_NULL_HANDLE;
    swapchain->canvas_memory = VK_NULL_HANDLE;
    swapchain->canvas_extent = (VkExtent2D){0};
}

static whit_result wait_idle(struct swapchain *swapchain)
{
    struct device *device = swapchain->device;
    whit_result result = WHIT_OK;
    if (swapchain->in_flight)
        VK_TRY(device, vkWaitForFences(device->vk, 1, &swapchain->fence, VK_TRUE, UINT64_MAX));
    swapchain->in_flight = false;
fail:
    return result;
}

void swapchain_destroy(struct swapchain *swapchain)
{
    if (!swapchain)
        return;
    VkDevice vk = swapchain->device->vk;
    (void)vkDeviceWaitIdle(vk); /* a lost device has nothing left to wait for */
    drop_views(swapchain);
    drop_canvas(swapchain);
    buffer_destroy(swapchain->picture);
    buffer_destroy(swapchain->capture);
    vkDestroySwapchainKHR(vk, swapchain->vk, NULL);
    vkDestroyPipeline(vk, swapchain->pipeline, NULL);
    vkDestroyPipelineLayout(vk, swapchain->layout, NULL);
    vkDestroyDescriptorPool(vk, swapchain->descriptors, NULL);
    vkDestroyDescriptorSetLayout(vk, swapchain->set_layout, NULL);
    vkDestroyRenderPass(vk, swapchain->pass, NULL);
    vkDestroySemaphore(vk, swapchain->acquired, NULL);
    vkDestroyQueryPool(vk, swapchain->queries, NULL);
    vkDestroyFence(vk, swapchain->fence, NULL);
    vkDestroyCommandPool(vk, swapchain->pool, NULL);
    free(swapchain);
}

static VkPresentModeKHR choose_mode(const struct swapchain *swapchain)
{
    VkPresentModeKHR modes[16];
    uint32_t count = sizeof modes / sizeof *modes;
    VkPresentModeKHR best = VK_PRESENT_MODE_FIFO_KHR; /* the one that is always there */
    if (swapchain->vsync ||
        vkGetPhysicalDeviceSurfacePresentModesKHR(swapchain->device->physical,
                                                  swapchain->device->surface, &count, modes) < 0)
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
    uint32_t most = can.maxImageCount ? can.maxImageCount : IMAGES_MOST;
    VkSwapchainCreateInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
        .surface = device->surface,
        .minImageCount = clamp(can.minImageCount, 2, most),
        .imageFormat = swapchain->format.format,
        .imageColorSpace = swapchain->format.colorSpace,
        .imageExtent = extent,
        .imageArrayLayers = 1,
        .imageUsage =
            VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
            (swapchain->direct ? VK_IMAGE_USAGE_STORAGE_BIT : VK_IMAGE_USAGE_TRANSFER_DST_BIT) |
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
        vkDestroySwapchainKHR(device->vk, old, NULL);
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
    VkDescriptorSetAllocateInfo set = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
        .descriptorPool = swapchain->descriptors,
        .descriptorSetCount = 1,
        .pSetLayouts = &swapchain->set_layout,
    };
    device_name_object(device, VK_OBJECT_TYPE_IMAGE, (uint64_t)image->image, "window image");
    VK_TRY(device, vkCreateImageView(device->vk, &view, NULL, &image->view));
    VK_TRY(device, vkCreateFramebuffer(device->vk, &framebuffer, NULL, &image->framebuffer));
    if (swapchain->direct)
        VK_TRY(device, vkAllocateDescriptorSets(device->vk, &set, &image->set));
    result = make_semaphore(device, "picture drawn", &image->drawn);
fail:
    return result;
}

static whit_result make_views(struct swapchain *swapchain)
{
    struct device *device = swapchain->device;
    VkImage images[IMAGES_MOST];
    uint32_t count = 0;
    whit_result result = WHIT_OK;
    VK_TRY(device, vkGetSwapchainImagesKHR(device->vk, swapchain->vk, &count, NULL));
    if (count > IMAGES_MOST) {
        log_error(&device->log, "the window wants %u images; whit keeps %d at most", count,
                  IMAGES_MOST);
        return WHIT_ERROR_DEVICE;
    }
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
    whit_result result = wait_idle(swapchain);
    if (result != WHIT_OK)
        return result;
    VK_TRY(device, vkQueueWaitIdle(device->queue)); /* semaphores of the last present */
    drop_views(swapchain);
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

/* ---- The picture ---- */

static whit_result make_canvas(struct swapchain *swapchain, uint32_t width, uint32_t height)
{
    struct device *device = swapchain->device;
    whit_result result = WHIT_OK;
    VkImageCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .imageType = VK_IMAGE_TYPE_2D,
        .format = VK_FORMAT_R8G8B8A8_UNORM,
        .extent = {width, height, 1},
        .mipLevels = 1,
        .arrayLayers = 1,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .tiling = VK_IMAGE_TILING_OPTIMAL,
        .usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
    };
    drop_canvas(swapchain);
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

whit_result swapchain_set_picture(struct swapchain *swapchain, const uint8_t *rgba, uint32_t width,
                                  uint32_t height)
{
    uint64_t bytes = (uint64_t)width * height * 4;
    whit_result result = wait_idle(swapchain);
    if (result == WHIT_OK && (!swapchain->picture || buffer_size(swapchain->picture) < bytes)) {
        buffer_destroy(swapchain->picture);
        swapchain->picture = NULL;
        swapchain->picture_width = swapchain->picture_height = 0;
        result = buffer_create(swapchain->device, bytes, BUFFER_STORAGE | BUFFER_HOST,
                               "window picture", &swapchain->picture);
    }
    if (result == WHIT_OK && !swapchain->direct &&
        (swapchain->canvas_extent.width != width || swapchain->canvas_extent.height != height))
        result = make_canvas(swapchain, width, height);
    if (result == WHIT_OK)
        result = buffer_write(swapchain->picture, 0, rgba, bytes);
    if (result != WHIT_OK)
        return result;
    swapchain->picture_width = width;
    swapchain->picture_height = height;
    return WHIT_OK;
}

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

/* Leaves the image in layout GENERAL. */
static void record_direct(struct swapchain *swapchain, const struct window_image *image)
{
    VkCommandBuffer commands = swapchain->commands;
    VkExtent2D window = swapchain->extent;
    VkDescriptorBufferInfo buffer = {.buffer = swapchain->picture->vk, .range = VK_WHOLE_SIZE};
    VkDescriptorImageInfo target = {.imageView = image->view,
                                    .imageLayout = VK_IMAGE_LAYOUT_GENERAL};
    const VkWriteDescriptorSet writes[] = {
        {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
         .dstSet = image->set,
         .dstBinding = 0,
         .descriptorCount = 1,
         .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
         .pBufferInfo = &buffer},
        {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
         .dstSet = image->set,
         .dstBinding = 1,
         .descriptorCount = 1,
         .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
         .pImageInfo = &target},
    };
    const struct present_push push = {swapchain->picture_width, swapchain->picture_height,
                                      window.width, window.height};
    vkUpdateDescriptorSets(swapchain->device->vk, 2, writes, 0, NULL);
    change_layout(swapchain, image->image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, swapchain->pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, swapchain->layout, 0, 1,
                            &image->set, 0, NULL);
    vkCmdPushConstants(commands, swapchain->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof push,
                       &push);
    vkCmdDispatch(commands, (window.width + PRESENT_GROUP - 1) / PRESENT_GROUP,
                  (window.height + PRESENT_GROUP - 1) / PRESENT_GROUP, 1);
}

/* Leaves the image in layout TRANSFER_DST_OPTIMAL. */
static void record_blit(struct swapchain *swapchain, const struct window_image *image)
{
    VkCommandBuffer commands = swapchain->commands;
    VkExtent2D from = swapchain->canvas_extent, to = swapchain->extent;
    bool same = from.width == to.width && from.height == to.height;
    const VkImageSubresourceLayers layers = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    VkBufferImageCopy copy = {.imageSubresource = layers,
                              .imageExtent = {from.width, from.height, 1}};
    VkImageBlit blit = {
        .srcSubresource = layers,
        .srcOffsets = {{0, 0, 0}, {(int32_t)from.width, (int32_t)from.height, 1}},
        .dstSubresource = layers,
        .dstOffsets = {{0, 0, 0}, {(int32_t)to.width, (int32_t)to.height, 1}},
    };
    change_layout(swapchain, swapchain->canvas, VK_IMAGE_LAYOUT_UNDEFINED,
                  VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    vkCmdCopyBufferToImage(commands, swapchain->picture->vk, swapchain->canvas,
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
    change_layout(swapchain, swapchain->canvas, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                  VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    change_layout(swapchain, image->image, VK_IMAGE_LAYOUT_UNDEFINED,
                  VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    vkCmdBlitImage(commands, swapchain->canvas, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, image->image,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit,
                   same ? VK_FILTER_NEAREST : VK_FILTER_LINEAR);
}

/* Where there is no picture yet. Leaves the image in layout TRANSFER_DST_OPTIMAL or GENERAL. */
static VkImageLayout record_picture(struct swapchain *swapchain, const struct window_image *image)
{
    if (swapchain->picture_width == 0) {
        /* No clear: it would want a usage more. What is drawn over it fills the window. */
        change_layout(swapchain, image->image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
        return VK_IMAGE_LAYOUT_GENERAL;
    }
    if (swapchain->direct) {
        record_direct(swapchain, image);
        return VK_IMAGE_LAYOUT_GENERAL;
    }
    record_blit(swapchain, image);
    return VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
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

/* The image is in layout COLOR_ATTACHMENT_OPTIMAL; *layout tells in which it is left. */
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
        result = buffer_create(swapchain->device, bytes, BUFFER_STORAGE | BUFFER_HOST,
                               "window copy", &swapchain->capture);
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
    VkImageLayout layout;
    whit_result result = begin_commands(swapchain);
    if (result != WHIT_OK)
        return result;
    if (swapchain->queries)
        vkCmdResetQueryPool(swapchain->commands, swapchain->queries, 0, 2);
    stamp(swapchain, 0);
    layout = record_picture(swapchain, image);
    change_layout(swapchain, image->image, layout, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    record_overlay(swapchain, image, draw, user);
    layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
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

/* Suboptimal and out-of-date are no errors: *usable and swapchain->stale tell. */
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
    whit_result result = wait_idle(swapchain);
    if (result != WHIT_OK || swapchain->extent.width == 0)
        return result;
    if (had_one)
        read_time(swapchain);
    if (swapchain->stale)
        return WHIT_OK; /* for swapchain_resize */
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
    whit_result result = wait_idle(swapchain);
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
    whit_result result = wait_idle(swapchain);
    if (result == WHIT_OK)
        result = begin_commands(swapchain);
    if (result != WHIT_OK)
        return result;
    fn(user, swapchain->commands);
    VK_TRY(device, vkEndCommandBuffer(swapchain->commands));
    result = submit(swapchain, VK_NULL_HANDLE, VK_NULL_HANDLE);
    if (result == WHIT_OK)
        result = wait_idle(swapchain);
fail:
    return result;
}

void swapchain_get_info(const struct swapchain *swapchain, struct swapchain_info *info)
{
    *info = swapchain->info;
    info->width = swapchain->extent.width;
    info->height = swapchain->extent.height;
    info->image_count = swapchain->image_count;
    info->direct = swapchain->direct;
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

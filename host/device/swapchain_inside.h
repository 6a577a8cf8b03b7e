/* What is behind struct swapchain; only swapchain.c and swapchain_show.c see it. */
#ifndef DEVICE_SWAPCHAIN_INSIDE_H
#define DEVICE_SWAPCHAIN_INSIDE_H

#include "device/swapchain.h"
#include "device/vulkan.h"

enum { IMAGES_MAX = 8 };

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
    struct window_image images[IMAGES_MAX];

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

/* swapchain_show.c: until the last picture is drawn; afterwards no image of it is in use. */
WHIT_CHECK whit_result swapchain_wait(struct swapchain *swapchain);
/* Frees the picture's own image, if there is one; nothing may be in flight. */
void swapchain_drop_canvas(struct swapchain *swapchain);

#endif

/* The fields of struct swapchain; only swapchain.c and swapchain_show.c see them. */
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
};

struct swapchain {
    struct device *device;
    bool swaps; /* blue is the format's first byte */
    bool vsync, captures, captured, stale;
    VkSurfaceFormatKHR format;
    VkExtent2D extent; /* 0 x 0: no images */
    VkSwapchainKHR vk;
    uint32_t image_count;
    struct window_image images[IMAGES_MAX];

    struct commands *commands;
    VkSemaphore acquired;
    VkRenderPass pass;

    struct buffer *picture; /* of the window's size, in host memory, in the order of `format` */
    bool has_picture;       /* since the window has its size */
    struct buffer *capture;
    struct swapchain_info info;
};

/* Waits for the last submission, after which the device uses none of the swapchain's images. */
WHIT_CHECK whit_result swapchain_wait(struct swapchain *swapchain);

#endif

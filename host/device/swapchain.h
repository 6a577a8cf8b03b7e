/* Pictures in a window. A device that was made with a surface has one swapchain over it; one thread
   uses both. */
#ifndef DEVICE_SWAPCHAIN_H
#define DEVICE_SWAPCHAIN_H

#include "device/device.h"

struct swapchain;

struct swapchain_params {
    bool vsync; /* pictures wait for the screen's refresh; else they are shown as soon as the device
                   can */
};

/* Chooses a format without sRGB conversion, as pictures are already in sRGB. WHIT_ERROR_NO_DEVICE,
   logged, where the window supports no known format. Nothing is shown before swapchain_resize. */
WHIT_CHECK whit_result swapchain_create(struct device *device,
                                        const struct swapchain_params *params,
                                        struct swapchain **out);
void swapchain_destroy(struct swapchain *swapchain); /* waits first; NULL is fine */

/* Makes the images anew for a window of this size in pixels. 0 x 0, as of a minimised window, is
   fine: then nothing is shown until the next call. The picture has to be set again. */
WHIT_CHECK whit_result swapchain_resize(struct swapchain *swapchain, uint32_t width,
                                        uint32_t height);

/* Sets the picture that swapchain_show shows from now on: RGBA bytes, sRGB, row 0 at the top. It is
   copied, and stretched to the window where the sizes differ. Until it is called, the window is
   dark. */
WHIT_CHECK whit_result swapchain_set_picture(struct swapchain *swapchain, const uint8_t *rgba,
                                             uint32_t width, uint32_t height);

struct swapchain_info {
    uint32_t width, height; /* of its images; 0: nothing is shown */
    uint32_t image_count;
    bool stale;                 /* the window changed: nothing is shown before swapchain_resize */
    const char *format;         /* "B8G8R8A8" */
    double wait_ms, present_ms; /* host time of the last swapchain_show: waiting for the image and
                                   the last submission; in the call that presents */
    double draw_ms; /* device time of the picture and of what is drawn over it; < 0: not measured */
    uint32_t recreated; /* how often the images were made anew */
};
void swapchain_get_info(const struct swapchain *swapchain, struct swapchain_info *info);

/* Draws over the picture; `commands` is a VkCommandBuffer inside the render pass of
   swapchain_get_handles. */
typedef void (*swapchain_draw)(void *user, void *commands);

/* Shows the picture with what `draw` (may be NULL) puts over it. `keep`: keeps a copy of the window
   for swapchain_read. *shown is false where the window is 0 x 0 or changed meanwhile: then call
   swapchain_resize and show it again. Errors: WHIT_ERROR_DEVICE for a lost device,
   WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result swapchain_show(struct swapchain *swapchain, swapchain_draw draw, void *user,
                                      bool keep, bool *shown);
/* Reads what swapchain_show showed and kept, overlay included, as RGBA bytes: width * height * 4 of
   them. `rgba` has room for `bytes`. WHIT_ERROR_USAGE where nothing was kept. */
WHIT_CHECK whit_result swapchain_read(struct swapchain *swapchain, uint8_t *rgba, size_t bytes);

/* Borrowed Vulkan handles, for libraries that call Vulkan themselves. */
struct swapchain_handles {
    void *instance, *physical, *device, *queue; /* dispatchable Vulkan handles */
    uint64_t render_pass, pipeline_cache;       /* non-dispatchable ones */
    uint32_t queue_family, image_count;
};
void swapchain_get_handles(const struct swapchain *swapchain, struct swapchain_handles *handles);
/* Lets `record` record commands, submits them and waits: for uploads of such libraries. */
WHIT_CHECK whit_result swapchain_submit(struct swapchain *swapchain,
                                        void (*record)(void *user, void *commands), void *user);
/* Reports that a call of such a library failed with the VkResult `vk` < 0: logs it once and returns
   what it means here. What the library made may stay until the device is destroyed, so messages of
   the validation layers are ignored from here on. */
WHIT_CHECK whit_result swapchain_failed(struct swapchain *swapchain, int vk, const char *of_what);

#endif

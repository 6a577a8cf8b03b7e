/* Pictures in a window. A device that was made with a surface has one swapchain over it; one thread
   uses both. */
#ifndef DEVICE_SWAPCHAIN_H
#define DEVICE_SWAPCHAIN_H

#include "device/device.h"

struct swapchain;

struct swapchain_params {
    bool vsync; /* a picture waits for the screen; else it is shown as soon as the device can */
};

/* Chooses a format without sRGB conversion, as pictures are already in sRGB. WHIT_ERROR_NO_DEVICE,
   logged, where the window supports no known format. Nothing is shown before swapchain_resize. */
WHIT_CHECK whit_result swapchain_create(struct device *device,
                                        const struct swapchain_params *params,
                                        struct swapchain **out);
void swapchain_destroy(struct swapchain *swapchain); /* waits first; NULL is fine */

/* To a window of so many pixels; 0 x 0, as of a window that is minimised, is fine: nothing is shown
   until the next size. Keeps the picture. */
WHIT_CHECK whit_result swapchain_resize(struct swapchain *swapchain, uint32_t width,
                                        uint32_t height);

/* The picture that is shown from the next swapchain_show on: RGBA bytes, sRGB, row 0 at the top.
   Stretched to the window where sizes differ. Copied. */
WHIT_CHECK whit_result swapchain_set_picture(struct swapchain *swapchain, const uint8_t *rgba,
                                             uint32_t width, uint32_t height);

struct swapchain_info {
    uint32_t width, height; /* of its images; 0: nothing is shown */
    uint32_t image_count;
    bool stale;                 /* the window changed: nothing is shown before swapchain_resize */
    const char *format;         /* "B8G8R8A8" */
    double wait_ms, present_ms; /* of the last swapchain_show, on the host: until the image and the
                                   last submission were free; in the call that presents */
    double draw_ms;             /* on the device: the picture and what is drawn over it; < 0: not
                                   measured */
    uint32_t recreated;         /* how often the images were made anew */
};
void swapchain_get_info(const struct swapchain *swapchain, struct swapchain_info *info);

/* What draws over the picture; `commands` is a VkCommandBuffer inside the render pass of
   swapchain_get_handles. */
typedef void (*swapchain_draw)(void *user, void *commands);

/* Shows the picture with what `draw` (may be NULL) puts over it. *shown: false where there was
   nothing to show it on (0 x 0), or the window changed under it: then ask again, with the new size.
   Errors: WHIT_ERROR_DEVICE for a lost device, WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result swapchain_show(struct swapchain *swapchain, swapchain_draw draw, void *user,
                                      bool *shown);

/* The same, and a copy of the window is kept for swapchain_read. */
WHIT_CHECK whit_result swapchain_show_and_keep(struct swapchain *swapchain, swapchain_draw draw,
                                               void *user, bool *shown);
/* What swapchain_show_and_keep showed, with what was drawn over it, as RGBA bytes of
   width * height * 4; `rgba` has place for `bytes`. WHIT_ERROR_USAGE where nothing was kept. */
WHIT_CHECK whit_result swapchain_read(struct swapchain *swapchain, uint8_t *rgba, size_t bytes);

/* For libraries that draw by themselves. Borrowed. */
struct swapchain_handles {
    void *instance, *physical, *device, *queue; /* dispatchable Vulkan handles */
    uint64_t render_pass, pipeline_cache;       /* others */
    uint32_t queue_family, image_count;
};
void swapchain_get_handles(const struct swapchain *swapchain, struct swapchain_handles *handles);
/* Records with `record`, submits and waits: for uploads of such libraries. */
WHIT_CHECK whit_result swapchain_submit(struct swapchain *swapchain,
                                        void (*record)(void *user, void *commands), void *user);
/* A call of such a library gave `vk`, a VkResult below 0: logged once, and what it means here. What
   the library made may stay until the device goes: the validation layers are not heard on that. */
WHIT_CHECK whit_result swapchain_failed(struct swapchain *swapchain, int vk, const char *of_what);

#endif

/* What swapchain_show.c has for swapchain.c alone. */
#ifndef DEVICE_SWAPCHAIN_SHOW_H
#define DEVICE_SWAPCHAIN_SHOW_H

#include "device/swapchain_inside.h"

/* Waits for the last submission; then the device works on none of the swapchain's images. */
WHIT_CHECK whit_result swapchain_wait(struct swapchain *swapchain);
/* Frees the picture's own image, if there is one; nothing may be in flight. */
void swapchain_drop_canvas(struct swapchain *swapchain);

#endif

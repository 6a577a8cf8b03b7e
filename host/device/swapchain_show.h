/* What swapchain_show.c has for swapchain.c alone. */
#ifndef DEVICE_SWAPCHAIN_SHOW_H
#define DEVICE_SWAPCHAIN_SHOW_H

#include "device/swapchain_inside.h"

/* Until the last picture is drawn; afterwards no image of it is in use. */
WHIT_CHECK whit_result swapchain_wait(struct swapchain *swapchain);
/* Frees the picture's own image, if there is one; nothing may be in flight. */
void swapchain_drop_canvas(struct swapchain *swapchain);

#endif

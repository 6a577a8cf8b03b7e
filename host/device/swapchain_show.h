/* A function of swapchain_show.c that only swapchain.c calls. */
#ifndef DEVICE_SWAPCHAIN_SHOW_H
#define DEVICE_SWAPCHAIN_SHOW_H

#include "device/swapchain_inside.h"

/* Waits for the last submission, after which the device uses none of the swapchain's images. */
WHIT_CHECK whit_result swapchain_wait(struct swapchain *swapchain);

#endif

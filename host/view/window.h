/* A window by GLFW: its events, its surface for Vulkan, its place on the screen. One at a time, of
   the main thread. */
#ifndef VIEW_WINDOW_H
#define VIEW_WINDOW_H

#include "device/device.h"
#include "view/events.h"

struct window;

struct window_params {
    const char *title;
    uint32_t width, height; /* pixels */
    bool fullscreen;
};

/* WHIT_ERROR_NO_DEVICE, logged, where there is no display, or no Vulkan for its windows. */
WHIT_CHECK whit_result window_create(const whit_log *log, const struct window_params *params,
                                     struct window **out);
void window_destroy(struct window *window); /* after the device; NULL is fine */

/* For device_params; borrowed from the window. */
const struct device_surface *window_surface(const struct window *window);

/* Waits for something to happen, at most `seconds` (0: not at all), and gathers it. */
void window_wait(struct window *window, double seconds);
/* From any thread: ends a window_wait. */
void window_wake(void *window);
/* The next of what was gathered; false when there is none. Positions and sizes are in pixels. */
bool window_next(struct window *window, struct view_event *event);

/* 0 x 0 while it is minimised. */
void window_pixels(const struct window *window, uint32_t *width, uint32_t *height);
float window_scale(const struct window *window); /* of the monitor: 1 at 96 dots an inch */
void window_set_title(struct window *window, const char *title);
void window_set_pixels(struct window *window, uint32_t width, uint32_t height);
void window_set_fullscreen(struct window *window, bool fullscreen);
bool window_is_fullscreen(const struct window *window);
/* Whether the window manager has made of it what was asked for last. */
bool window_is_settled(const struct window *window);
void window_set_minimised(struct window *window, bool minimised);
void window_copy(struct window *window, const char *text); /* to the clipboard */

#endif

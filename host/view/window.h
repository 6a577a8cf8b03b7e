/* A window of GLFW: its events, its Vulkan surface, its place on the screen. One at a time, for the
   main thread. */
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

/* WHIT_ERROR_NO_DEVICE, logged, if there is no display, or no Vulkan for its windows. */
WHIT_CHECK whit_result window_create(const whit_log *log, const struct window_params *params,
                                     struct window **out);
void window_destroy(struct window *window); /* call it after destroying the device; NULL is fine */

/* For device_create; borrowed from the window. */
const struct device_surface *window_surface(const struct window *window);

/* Waits for events, at most `seconds` (0: not at all), and queues them. */
void window_wait(struct window *window, double seconds);
/* Ends a window_wait; may be called from any thread. */
void window_wake(void *window);
/* Takes the next queued event; false: there is none. Positions and sizes are in pixels. */
bool window_next(struct window *window, struct view_event *event);

/* The size of the window's image; 0 x 0 while it is minimised. */
void window_pixels(const struct window *window, uint32_t *width, uint32_t *height);
float window_scale(const struct window *window); /* scale of the monitor: 1 at 96 dots an inch */
void window_set_title(struct window *window, const char *title);
void window_set_pixels(struct window *window, uint32_t width, uint32_t height);
void window_set_fullscreen(struct window *window, bool fullscreen);
bool window_is_fullscreen(const struct window *window);
/* Whether the window has the size that was asked for last. */
bool window_is_settled(const struct window *window);
void window_set_minimised(struct window *window, bool minimised);
void window_copy(struct window *window, const char *text); /* copies it to the clipboard */

#endif

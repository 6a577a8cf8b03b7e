#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>

#include "view/window.h"

#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/child.h"
#include "base/file.h"

enum { EVENTS_HELD = 256 };
enum { WINDOW_LOST_EXIT = 3 }; /* as where there is no display */

struct window {
    whit_log log;
    GLFWwindow *glfw;
    struct device_surface surface;
    bool fullscreen;
    int x, y, width, height;         /* place and size before full screen */
    int wanted_width, wanted_height; /* size asked for last, screen units; 0: none */
    struct view_event events[EVENTS_HELD];
    uint32_t first, count;
    char dropped[EVENT_PATH]; /* path of the last dropped file */
    char error[256];
};

/* GLFW reports errors without naming a window. */
static struct window *the_window;

static void on_error(int code, const char *text)
{
    (void)code;
    if (the_window && !the_window->error[0])
        snprintf(the_window->error, sizeof the_window->error, "%s", text);
}

/* ---- Events ---- */

/* Queues an event. A move, a size or a refresh takes the place of the last queued event if that is
   of the same kind. When the queue is full, the oldest event is lost. */
static void push(struct window *window, const struct view_event *event)
{
    if (window->count > 0) {
        struct view_event *last =
            &window->events[(window->first + window->count - 1) % EVENTS_HELD];
        if (last->kind == event->kind && (event->kind == EVENT_MOVE || event->kind == EVENT_SIZE ||
                                          event->kind == EVENT_REFRESH)) {
            *last = *event;
            return;
        }
    }
    if (window->count == EVENTS_HELD) {
        window->first = (window->first + 1) % EVENTS_HELD;
        --window->count;
    }
    window->events[(window->first + window->count++) % EVENTS_HELD] = *event;
}

static int key_from_glfw(int key)
{
    static const struct {
        int glfw, key;
    } all[] = {
        {GLFW_KEY_ESCAPE, KEY_ESCAPE},
        {GLFW_KEY_ENTER, KEY_ENTER},
        {GLFW_KEY_KP_ENTER, KEY_ENTER},
        {GLFW_KEY_TAB, KEY_TAB},
        {GLFW_KEY_BACKSPACE, KEY_BACKSPACE},
        {GLFW_KEY_DELETE, KEY_DELETE},
        {GLFW_KEY_LEFT, KEY_LEFT},
        {GLFW_KEY_RIGHT, KEY_RIGHT},
        {GLFW_KEY_UP, KEY_UP},
        {GLFW_KEY_DOWN, KEY_DOWN},
        {GLFW_KEY_HOME, KEY_HOME},
        {GLFW_KEY_END, KEY_END},
        {GLFW_KEY_KP_SUBTRACT, '-'},
        {GLFW_KEY_KP_ADD, '='},
        {GLFW_KEY_LEFT_SHIFT, KEY_SHIFT},
        {GLFW_KEY_RIGHT_SHIFT, KEY_SHIFT},
        {GLFW_KEY_LEFT_CONTROL, KEY_CTRL},
        {GLFW_KEY_RIGHT_CONTROL, KEY_CTRL},
        {GLFW_KEY_LEFT_ALT, KEY_ALT},
        {GLFW_KEY_RIGHT_ALT, KEY_ALT},
    };
    if (key >= GLFW_KEY_F1 && key <= GLFW_KEY_F12)
        return KEY_F1 + key - GLFW_KEY_F1;
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) {
        if (all[i].glfw == key)
            return all[i].key;
    }
    return key >= GLFW_KEY_SPACE && key <= GLFW_KEY_GRAVE_ACCENT ? key : -1;
}

static unsigned mods_from_glfw(int mods)
{
    return (mods & GLFW_MOD_SHIFT ? EVENT_SHIFT : 0u) |
           (mods & GLFW_MOD_CONTROL ? EVENT_CTRL : 0u) | (mods & GLFW_MOD_ALT ? EVENT_ALT : 0u);
}

/* Letters and signs by what is printed on their keys, for any keyboard layout. Keys of digits are
   these digits also where they print others (French), unless the sign has a use; `+` is `=`. */
static int printed_key(int key, int scancode)
{
    const char *name = glfwGetKeyName(key, scancode);
    if (!name || !name[0] || name[1])
        return key;
    if (key >= GLFW_KEY_0 && key <= GLFW_KEY_9 && !strchr("-=[]\\", name[0]))
        return key;
    if (name[0] == '+')
        return '=';
    return name[0] >= 'a' && name[0] <= 'z' ? name[0] - 'a' + 'A' : name[0];
}

static void on_key(GLFWwindow *glfw, int key, int scancode, int action, int mods)
{
    int own = key_from_glfw(printed_key(key, scancode));
    if (own == '=')
        mods &= ~GLFW_MOD_SHIFT; /* where + stands above = */
    struct view_event event = {.kind = EVENT_KEY,
                               .key = own,
                               .down = action != GLFW_RELEASE,
                               .mods = mods_from_glfw(mods)};
    if (own >= 0)
        push(glfwGetWindowUserPointer(glfw), &event);
}

static void on_character(GLFWwindow *glfw, unsigned code)
{
    push(glfwGetWindowUserPointer(glfw), &(struct view_event){.kind = EVENT_CHAR, .code = code});
}

static void on_button(GLFWwindow *glfw, int button, int action, int mods)
{
    if (button <= GLFW_MOUSE_BUTTON_MIDDLE)
        push(glfwGetWindowUserPointer(glfw), &(struct view_event){.kind = EVENT_BUTTON,
                                                                  .button = button,
                                                                  .down = action == GLFW_PRESS,
                                                                  .mods = mods_from_glfw(mods)});
}

/* GLFW uses screen units, which need not be pixels. */
static void on_move(GLFWwindow *glfw, double x, double y)
{
    int width, height, pixels_x, pixels_y;
    glfwGetWindowSize(glfw, &width, &height);
    glfwGetFramebufferSize(glfw, &pixels_x, &pixels_y);
    if (width > 0 && height > 0)
        push(glfwGetWindowUserPointer(glfw), &(struct view_event){.kind = EVENT_MOVE,
                                                                  .x = x * pixels_x / width,
                                                                  .y = y * pixels_y / height});
}

static void on_wheel(GLFWwindow *glfw, double x, double y)
{
    push(glfwGetWindowUserPointer(glfw), &(struct view_event){.kind = EVENT_WHEEL, .x = x, .y = y});
}

static void on_pixels(GLFWwindow *glfw, int width, int height)
{
    push(glfwGetWindowUserPointer(glfw), &(struct view_event){.kind = EVENT_SIZE,
                                                              .width = (uint32_t)width,
                                                              .height = (uint32_t)height});
}

static void on_drop(GLFWwindow *glfw, int count, const char **paths)
{
    struct window *window = glfwGetWindowUserPointer(glfw);
    if (count > 0 && strlen(paths[0]) < sizeof window->dropped) {
        memcpy(window->dropped, paths[0], strlen(paths[0]) + 1);
        push(window, &(struct view_event){.kind = EVENT_DROP, .path = window->dropped});
    }
}

static void on_close(GLFWwindow *glfw)
{
    push(glfwGetWindowUserPointer(glfw), &(struct view_event){.kind = EVENT_CLOSE});
}

static void on_refresh(GLFWwindow *glfw)
{
    push(glfwGetWindowUserPointer(glfw), &(struct view_event){.kind = EVENT_REFRESH});
}

static void on_minimise(GLFWwindow *glfw, int minimised)
{
    uint32_t width = 0, height = 0;
    if (!minimised)
        window_pixels(glfwGetWindowUserPointer(glfw), &width, &height);
    on_pixels(glfw, (int)width, (int)height);
}

/* ---- Making ---- */

static int make_surface(void *user, void *instance, void *surface)
{
    struct window *window = user;
    return glfwCreateWindowSurface(instance, window->glfw, NULL, surface);
}

static whit_result fail(struct window *window, const char *what)
{
    return log_failure(&window->log, WHIT_ERROR_NO_DEVICE,
                       "%s%s%s; `whit render` draws without a window", what,
                       window->error[0] ? ": " : "", window->error);
}

/* Xlib would end the process with exit code 1, which whit has for promises that failed. */
static int lose_display(void *display)
{
    (void)display;
    if (the_window)
        log_error(&the_window->log,
                  "the display of the window is gone; `whit render` draws without a window");
    file_abandon_all();
    _Exit(WINDOW_LOST_EXIT);
}

/* GLFW has loaded Xlib where it uses X11, and nothing else in whit does. */
static void watch_display(void)
{
    void (*set_handler)(int (*)(void *));
    void *xlib = dlopen("libX11.so.6", RTLD_LAZY | RTLD_NOLOAD);
    void *found = xlib ? dlsym(xlib, "XSetIOErrorHandler") : NULL;
    if (found) {
        memcpy(&set_handler, &found, sizeof found); /* C has no cast from data to functions */
        set_handler(lose_display);
    }
}

static whit_result make_window(struct window *window, const struct window_params *params)
{
    if (!glfwInit())
        return fail(window, "no display to open a window on");
    watch_display();
    if (!glfwVulkanSupported())
        return fail(window, "no Vulkan for windows here");
    window->surface.extensions =
        glfwGetRequiredInstanceExtensions(&window->surface.extension_count);
    if (!window->surface.extensions)
        return fail(window, "no Vulkan for windows here");
    window->surface.create = make_surface;
    window->surface.user = window;
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    window->glfw =
        glfwCreateWindow((int)params->width, (int)params->height, params->title, NULL, NULL);
    return window->glfw ? WHIT_OK : fail(window, "the window cannot be opened");
}

whit_result window_create(const whit_log *log, const struct window_params *params,
                          struct window **out)
{
    *out = NULL;
    struct window *window = array_alloc_zeroed(1, sizeof *window);
    if (!window)
        return log_failure(log, WHIT_ERROR_MEMORY, "out of memory for a window");
    window->log = *log;
    the_window = window;
    glfwSetErrorCallback(on_error);
    child_hold_forks(); /* GLFW loads libraries: see child.h */
    whit_result result = make_window(window, params);
    child_release_forks();
    if (result != WHIT_OK) {
        window_destroy(window);
        return result;
    }
    glfwSetWindowUserPointer(window->glfw, window);
    glfwSetKeyCallback(window->glfw, on_key);
    glfwSetCharCallback(window->glfw, on_character);
    glfwSetMouseButtonCallback(window->glfw, on_button);
    glfwSetCursorPosCallback(window->glfw, on_move);
    glfwSetScrollCallback(window->glfw, on_wheel);
    glfwSetFramebufferSizeCallback(window->glfw, on_pixels);
    glfwSetWindowIconifyCallback(window->glfw, on_minimise);
    glfwSetDropCallback(window->glfw, on_drop);
    glfwSetWindowCloseCallback(window->glfw, on_close);
    glfwSetWindowRefreshCallback(window->glfw, on_refresh);
    if (params->fullscreen)
        window_set_fullscreen(window, true);
    *out = window;
    return WHIT_OK;
}

void window_destroy(struct window *window)
{
    if (!window)
        return;
    if (window->glfw)
        glfwDestroyWindow(window->glfw);
    glfwTerminate();
    the_window = NULL;
    free(window);
}

const struct device_surface *window_surface(const struct window *window)
{
    return &window->surface;
}

void window_wait(struct window *window, double seconds)
{
    if (seconds <= 0.0 || window->count > 0)
        glfwPollEvents();
    else
        glfwWaitEventsTimeout(seconds);
}

void window_wake(void *window)
{
    (void)window;
    glfwPostEmptyEvent();
}

bool window_next(struct window *window, struct view_event *event)
{
    if (window->count == 0)
        return false;
    *event = window->events[window->first];
    window->first = (window->first + 1) % EVENTS_HELD;
    --window->count;
    return true;
}

void window_pixels(const struct window *window, uint32_t *width, uint32_t *height)
{
    int x = 0, y = 0;
    if (!glfwGetWindowAttrib(window->glfw, GLFW_ICONIFIED))
        glfwGetFramebufferSize(window->glfw, &x, &y);
    *width = (uint32_t)x;
    *height = (uint32_t)y;
}

float window_scale(const struct window *window)
{
    float x = 1.0f, y = 1.0f;
    glfwGetWindowContentScale(window->glfw, &x, &y);
    return y > 0.0f ? y : 1.0f;
}

void window_set_title(struct window *window, const char *title)
{
    char shown[1024];
    glfwSetWindowTitle(window->glfw, whit_text_show(title, shown, sizeof shown));
}

static void want_size(struct window *window, int width, int height)
{
    window->wanted_width = width;
    window->wanted_height = height;
}

bool window_is_settled(const struct window *window)
{
    int width, height;
    if (window->wanted_width == 0 || glfwGetWindowAttrib(window->glfw, GLFW_ICONIFIED))
        return true;
    glfwGetWindowSize(window->glfw, &width, &height);
    return width == window->wanted_width && height == window->wanted_height;
}

void window_set_pixels(struct window *window, uint32_t width, uint32_t height)
{
    int units_x, units_y, pixels_x, pixels_y;
    glfwGetWindowSize(window->glfw, &units_x, &units_y);
    glfwGetFramebufferSize(window->glfw, &pixels_x, &pixels_y);
    if (pixels_x == 0 || pixels_y == 0)
        return;
    want_size(window, (int)width * units_x / pixels_x, (int)height * units_y / pixels_y);
    glfwSetWindowSize(window->glfw, window->wanted_width, window->wanted_height);
}

void window_set_fullscreen(struct window *window, bool fullscreen)
{
    GLFWmonitor *monitor = glfwGetPrimaryMonitor();
    const GLFWvidmode *mode = monitor ? glfwGetVideoMode(monitor) : NULL;
    if (fullscreen == window->fullscreen || (fullscreen && !mode))
        return;
    window->fullscreen = fullscreen;
    if (fullscreen) {
        glfwGetWindowPos(window->glfw, &window->x, &window->y);
        glfwGetWindowSize(window->glfw, &window->width, &window->height);
        want_size(window, mode->width, mode->height);
        glfwSetWindowMonitor(window->glfw, monitor, 0, 0, mode->width, mode->height,
                             mode->refreshRate);
    } else {
        want_size(window, window->width, window->height);
        glfwSetWindowMonitor(window->glfw, NULL, window->x, window->y, window->width,
                             window->height, GLFW_DONT_CARE);
    }
}

bool window_is_fullscreen(const struct window *window)
{
    return window->fullscreen;
}

void window_set_minimised(struct window *window, bool minimised)
{
    if (minimised)
        glfwIconifyWindow(window->glfw);
    else
        glfwRestoreWindow(window->glfw);
}

void window_copy(struct window *window, const char *text)
{
    glfwSetClipboardString(window->glfw, text);
}

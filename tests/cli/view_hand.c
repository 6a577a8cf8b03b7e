/* A user and a window manager for the viewer's tests, on a display of their own: it minimises and
   restores windows when they ask for it, makes them as large as the screen, and does the orders on
   standard input, one a line, to the only window:
       title TEXT | key NAME | move X Y | button N down|up | close
   `title` waits until the window's title begins with TEXT. Events are sent to the window as an X
   server would send them. The program ends with its window. `view_hand DPI` first sets the
   resolution of the screen for all programs, as desktops do. */
#include <poll.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>

static Display *display;
static Window window;
static int x, y;

static Atom atom(const char *name)
{
    return XInternAtom(display, name, False);
}

static void set_property(Window of, const char *name, Atom type, int bits, const void *data,
                         int count)
{
    XChangeProperty(display, of, atom(name), type, bits, PropModeReplace, data, count);
}

static void set_state(Window of, long state)
{
    const long data[2] = {state, None};
    set_property(of, "WM_STATE", atom("WM_STATE"), 32, data, 2);
}

/* Announces the abilities of this window manager by the Extended Window Manager Hints. */
static void say_abilities(void)
{
    Window root = DefaultRootWindow(display);
    Window own = XCreateSimpleWindow(display, root, 0, 0, 1, 1, 0, 0, 0);
    const Atom able[] = {atom("_NET_WM_STATE"), atom("_NET_WM_STATE_FULLSCREEN")};
    set_property(root, "_NET_SUPPORTING_WM_CHECK", XA_WINDOW, 32, &own, 1);
    set_property(own, "_NET_SUPPORTING_WM_CHECK", XA_WINDOW, 32, &own, 1);
    set_property(root, "_NET_SUPPORTED", XA_ATOM, 32, able, 2);
}

static void say_dpi(const char *dpi)
{
    char text[64];
    int length = snprintf(text, sizeof text, "Xft.dpi:\t%.20s\n", dpi);
    set_property(DefaultRootWindow(display), "RESOURCE_MANAGER", XA_STRING, 8, text, length);
}

/* Removes the announcements: GLFW aborts if a window manager that has ended still seems to run. */
static void leave(void)
{
    static const char *const said[] = {"_NET_SUPPORTING_WM_CHECK", "_NET_SUPPORTED",
                                       "RESOURCE_MANAGER"};
    for (size_t i = 0; i < sizeof said / sizeof *said; ++i)
        XDeleteProperty(display, DefaultRootWindow(display), atom(said[i]));
    XSync(display, False);
    exit(0);
}

/* Makes the window as large as the screen, or as it was before. */
static void fill_screen(Window of, bool full)
{
    static XWindowAttributes before;
    static bool is_full;
    const Atom state = atom("_NET_WM_STATE_FULLSCREEN");
    if (full == is_full)
        return;
    is_full = full;
    if (full)
        XGetWindowAttributes(display, of, &before);
    int screen = DefaultScreen(display);
    XMoveResizeWindow(display, of, full ? 0 : before.x, full ? 0 : before.y,
                      (unsigned)(full ? DisplayWidth(display, screen) : before.width),
                      (unsigned)(full ? DisplayHeight(display, screen) : before.height));
    set_property(of, "_NET_WM_STATE", XA_ATOM, 32, &state, full ? 1 : 0);
    printf("%s\n", full ? "full" : "window");
    fflush(stdout);
}

static void manage(const XEvent *event)
{
    if (event->type == MapRequest) {
        window = event->xmaprequest.window;
        XSelectInput(display, window, PropertyChangeMask);
        XMapWindow(display, window);
        set_state(window, NormalState);
    } else if (event->type == ConfigureRequest) {
        const XConfigureRequestEvent *r = &event->xconfigurerequest;
        XWindowChanges changes = {.x = r->x,
                                  .y = r->y,
                                  .width = r->width,
                                  .height = r->height,
                                  .border_width = r->border_width,
                                  .sibling = r->above,
                                  .stack_mode = r->detail};
        XConfigureWindow(display, r->window, (unsigned)r->value_mask, &changes);
    } else if (event->type == ClientMessage &&
               event->xclient.message_type == atom("WM_CHANGE_STATE")) {
        XUnmapWindow(display, event->xclient.window);
        set_state(event->xclient.window, IconicState);
    } else if (event->type == ClientMessage &&
               event->xclient.message_type == atom("_NET_WM_STATE") &&
               event->xclient.data.l[1] == (long)atom("_NET_WM_STATE_FULLSCREEN")) {
        fill_screen(event->xclient.window, event->xclient.data.l[0] == 1); /* 1: add, 0: remove */
    } else if (event->type == DestroyNotify && event->xdestroywindow.window == window) {
        leave();
    }
    XFlush(display);
}

static void manage_all(void)
{
    while (XPending(display)) {
        XEvent event;
        XNextEvent(display, &event);
        manage(&event);
    }
}

static void wait_for_title(const char *text)
{
    for (;;) {
        XEvent event;
        char *title = NULL;
        bool there =
            XFetchName(display, window, &title) && title && strncmp(title, text, strlen(text)) == 0;
        if (title)
            XFree(title);
        if (there)
            return;
        XNextEvent(display, &event); /* every change of a title is one */
        manage(&event);
    }
}

/* Xlib lays out events of keys, buttons and moves alike. `detail`: which key or button. */
static void send(int type, long mask, unsigned detail)
{
    static Time time = 1000; /* GLFW takes two keys at the same time for one */
    XEvent event = {.xkey = {.type = type,
                             .display = display,
                             .window = window,
                             .root = DefaultRootWindow(display),
                             .time = time += 50,
                             .x = x,
                             .y = y,
                             .keycode = detail,
                             .same_screen = True}};
    XSendEvent(display, window, False, mask, &event);
}

static void press(const char *name)
{
    unsigned key = XKeysymToKeycode(display, XStringToKeysym(name));
    send(KeyPress, KeyPressMask, key);
    send(KeyRelease, KeyReleaseMask, key);
}

static void close_window(void)
{
    XClientMessageEvent event = {.type = ClientMessage,
                                 .display = display,
                                 .window = window,
                                 .message_type = atom("WM_PROTOCOLS"),
                                 .format = 32};
    event.data.l[0] = (long)atom("WM_DELETE_WINDOW");
    XSendEvent(display, window, False, NoEventMask, (XEvent *)&event);
}

static bool obey(const char *line)
{
    char word[32];
    unsigned number;
    if (sscanf(line, "title %31s", word) == 1)
        wait_for_title(word);
    else if (sscanf(line, "key %31s", word) == 1)
        press(word);
    else if (sscanf(line, "move %d %d", &x, &y) == 2)
        send(MotionNotify, PointerMotionMask, 0);
    else if (sscanf(line, "button %u %31s", &number, word) == 2 && strcmp(word, "down") == 0)
        send(ButtonPress, ButtonPressMask, number);
    else if (sscanf(line, "button %u %31s", &number, word) == 2)
        send(ButtonRelease, ButtonReleaseMask, number);
    else if (strncmp(line, "close", 5) == 0)
        close_window();
    else
        return false;
    XFlush(display);
    return true;
}

/* Ignores errors: a window may end while events are on their way to it. */
static int ignore(Display *of, XErrorEvent *event)
{
    (void)of;
    (void)event;
    return 0;
}

/* Reads a line without a buffer, which would hide further lines from poll. */
static bool read_line(char *line, size_t bytes)
{
    size_t length = 0;
    char c = 0;
    while (length + 1 < bytes && c != '\n' && read(STDIN_FILENO, &c, 1) == 1)
        line[length++] = c;
    line[length] = '\0';
    return length > 0;
}

int main(int argc, char **argv)
{
    char line[128];
    display = XOpenDisplay(NULL);
    if (!display)
        return 1;
    XSetErrorHandler(ignore);
    XSelectInput(display, DefaultRootWindow(display),
                 SubstructureRedirectMask | SubstructureNotifyMask);
    say_abilities();
    if (argc > 1)
        say_dpi(argv[1]);
    XSync(display, False);
    puts("ready"); /* windows may come */
    fflush(stdout);
    while (!window) {
        XEvent event;
        XNextEvent(display, &event);
        manage(&event);
    }
    for (bool more = true;;) { /* until the window is gone */
        struct pollfd from[2] = {{.fd = ConnectionNumber(display), .events = POLLIN},
                                 {.fd = more ? STDIN_FILENO : -1, .events = POLLIN}};
        manage_all();
        poll(from, 2, -1);
        if (!from[1].revents)
            continue;
        more = read_line(line, sizeof line);
        if (more && !obey(line)) {
            fprintf(stderr, "view_hand: what is `%s`?\n", line);
            return 2;
        }
    }
}

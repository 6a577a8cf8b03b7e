/* The viewer: a window on a scene. */
#ifndef VIEW_VIEW_H
#define VIEW_VIEW_H

#include "cost/cost.h"
#include "view/engine.h"

/* A picture to be saved with its recipe. */
struct view_shot {
    const struct settings *settings;
    const whit_image *color; /* linear, as `whit render` makes it */
    const whit_scene *scene;
    const whit_shader *shader; /* NULL: none */
    const whit_device_info *device;
    const whit_stats *stats;
};

struct view_params {
    struct settings settings; /* initial settings; the size of settings.picture is the window's */
    whit_shader_compiler *compiler; /* for settings.shader; its log is silent. NULL: no shaders */
    bool fullscreen, no_vsync;
    double spend_s; /* time for measuring costs, roughly; 0: a default */
    bool fresh;     /* --budget-ms and --max-error do not use figures of earlier runs */
    /* Figures for these two options, and the choices made by them, kept from one run to the next.
       load: false if there are none; *figures is then unchanged. */
    bool (*load_figures)(const struct cost_place *place, struct cost_kept_figures *figures);
    void (*save_figures)(const struct cost_place *place, const struct cost_kept_figures *figures);
    uint32_t frames;    /* number of pictures to show; 0: until the window is closed */
    const char *record; /* file to write events to, or NULL */
    const char *replay; /* file to read events from, or NULL */
    const char *hint;   /* message to begin with, or NULL */
    bool remember;      /* remember cameras from one run to the next */
    const volatile bool *cancel;
    /* Called when the window was closed without an error and the input is recorded, while the
       driver may be compiling; NULL: nothing is called. */
    void (*end)(void);
    /* Tells of a scene when its file is first shown; NULL: nothing is told. */
    void (*tell)(const whit_scene *scene);
    /* Saves a picture; logs the reason of an error. */
    whit_result (*save)(const struct view_shot *shot, const char *path, const whit_log *log);
    /* Reads a file of settings; scene and files of *settings stay. `message` gets the reason of an
       error, with file and line. */
    whit_result (*load_state)(void *user, const char *path, struct settings *settings,
                              char *message, size_t message_bytes);
    void *load_user;
    float ui_scale; /* scale of text and panels; 0: the monitor's */
};

/* Runs the viewer until its window is closed. WHIT_ERROR_NO_DEVICE, logged, without a display.
   On return *validation is the number of messages of the validation layers, about all devices. */
WHIT_CHECK whit_result view_run(const struct view_params *params, const whit_log *log,
                                uint32_t *validation);

#endif

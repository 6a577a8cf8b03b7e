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
    struct settings settings;       /* to begin with; settings.picture's size is the window's */
    whit_shader_compiler *compiler; /* of settings.shader, whose log is silent; NULL: none */
    bool fullscreen, no_vsync;
    double spend_s; /* on measuring costs, more or less; 0: as it suits */
    bool fresh;     /* for --budget-ms and --max-error what is kept is measured anew */
    /* Figures for these two and the choices made by them, from one run to the next. load: false
       where there are none; *figures is then untouched. NULL: nothing is kept. */
    bool (*load_figures)(const struct cost_place *place, struct cost_kept_figures *figures);
    void (*save_figures)(const struct cost_place *place, const struct cost_kept_figures *figures);
    uint32_t frames;    /* pictures shown before it ends; 0: until it is closed */
    const char *record; /* where events go, or NULL */
    const char *replay; /* where they come from, or NULL */
    const char *hint;   /* shown at first, or NULL */
    bool remember;      /* cameras, from one run to the next */
    const char *const
        *scenes; /* for the arrows, borrowed; settings.scene need not be one of them */
    uint32_t scene_count;
    const volatile bool *cancel;
    /* Saves a picture; the reason of a failure goes to the log. */
    whit_result (*save)(void *user, const struct view_shot *shot, const char *path);
    void *save_user;
    /* Reads a file of settings, over what *settings has of scene and files; `message` gets the
       reason of a failure, with file and line. May be NULL. */
    whit_result (*load_state)(void *user, const char *path, struct settings *settings,
                              char *message, size_t message_bytes);
    void *load_user;
    float ui_scale; /* of text and panels; 0: the monitor's */
};

/* Until the window is closed. WHIT_ERROR_NO_DEVICE, logged, without a display. *validation: how
   many messages the validation layers had, of all devices. */
WHIT_CHECK whit_result view_run(const struct view_params *params, const whit_log *log,
                                uint32_t *validation);

#endif

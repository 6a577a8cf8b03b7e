/* The viewer from inside: shared by the files of view/ that draw and act. */
#ifndef VIEW_VIEW_PRIVATE_H
#define VIEW_VIEW_PRIVATE_H

#include "device/swapchain.h"
#include "view/camera.h"
#include "view/compare.h"
#include "view/panels.h"
#include "view/shaders.h"
#include "view/ui.h"
#include "view/view.h"
#include "view/window.h"
#include "view/wish.h"

enum view_hud { HUD_OFF, HUD_SMALL, HUD_FULL, HUD_COUNT };
enum { TOAST_BYTES = 256, KEYS_MAX = 320, LEAVING_MAX = 4 };

/* What keys that are held, and the mouse, are at. */
struct view_input {
    bool down[KEYS_MAX];
    bool buttons[3];
    double x, y, press_x, press_y; /* of the mouse; where its button went down */
    bool dragged;                  /* since the button went down */
    double step_ms;                /* when held keys were last obeyed */
};

struct view_clock { /* of the animation */
    bool playing, once;
    double speed, last_ms;
};

/* A picture that takes longer shows how far it is. */
#define SLOW_MS 700.0

/* Pictures of the last moments, for the HUD. */
struct view_rate {
    double shown_ms[32]; /* one after the other, without a rest between */
    uint32_t count;
    double fps; /* 0: nothing went on */
};

/* Some figures, the first of many. */
enum { FIGURES_MAX = 4096 };
struct view_figures {
    uint32_t count;
    double values[FIGURES_MAX];
};

/* What the user waited for since the last `state`. */
struct view_measure {
    double first_ms;             /* when the first picture was shown, by the clock; 0: none yet */
    double last_ms;              /* the last new picture while something moved; 0: it stood */
    double shown_ms;             /* when the window was drawn last; 0: not yet */
    double cpu_ms;               /* of the process, when this began */
    double start_ms;             /* when this began */
    uint32_t drawn;              /* how often the window was drawn */
    uint64_t number;             /* of the last picture that was counted */
    struct view_figures whole;   /* ms of render of whole pictures */
    struct view_figures quick;   /* of those while something moves */
    struct view_figures size;    /* their divisors */
    struct view_figures gap;     /* ms from one new picture to the next, while something moves */
    struct view_figures between; /* ms from one drawing of the window to the next */
    struct view_figures latency; /* ms from the input to the picture that shows it */
    struct view_figures present; /* ms in the call that presents */
};

/* The clock of what the viewer does: how long messages stay, when a picture stands, how far an
   animation is. A replay turns it by its lines `wait`, so that load changes nothing. */
struct view_time {
    bool turned;
    double now_ms;   /* while it is turned */
    double ahead_ms; /* of the system's clock, once it no longer is */
};

struct view {
    whit_log log;
    const struct view_params *params;
    struct window *window;
    struct device *device;
    struct swapchain *swapchain;
    struct ui *ui;
    struct engine *engine;

    struct settings settings; /* wanted */
    /* Those of the last picture, or of the start: a switch that fails goes back to them. */
    struct settings fallback;
    struct view_camera camera; /* of settings.camera, as numbers */
    bool camera_known;         /* else the scene's first camera, not read as yet */
    int file_camera;           /* of the scene's, or -1 */
    uint32_t scene_index;      /* in params->scenes */

    struct engine_frame frame;
    struct engine_status status;
    struct engine_probe probe; /* the picked pixel; number 0: none */
    float pick_side;           /* of the window, where the panel of the pixel is: 0 left, 1 right */
    bool picked;               /* its panel is open */
    double pick_x, pick_y;     /* the pixel that was asked for last */
    uint64_t pick_frame;       /* number of the picture that it was asked of by itself */
    bool focus;                /* look at it when it is there */
    struct scene_ref *scene;   /* of `frame` */

    struct prices *prices;               /* NULL: none are asked for */
    struct prices *leaving[LEAVING_MAX]; /* stopped, and not at their end as yet */
    struct wish wish;
    bool prices_open;
    int prices_drawn; /* draws of its table */

    struct palette palette;
    struct compare compare;
    struct panels panels;
    struct shaders shaders;

    struct view_input input;
    struct view_clock clock;
    struct view_rate rate;
    struct view_measure measure;
    struct view_time time;
    double moved_ms; /* when the picture was last changed by hand */
    double drawn_ms; /* when the window was last drawn */
    double escape_ms;
    enum view_hud hud;
    bool help, hint;
    char toast[TOAST_BYTES];
    double toast_until_ms;
    double progress_ms; /* of the system's clock: when how far work is was shown last */
    bool dirty;         /* the window is to be drawn again */
    bool resized;       /* its images are to be made again */
    bool quit;
    uint32_t shown; /* pictures */
    bool picture_set;

    struct watch *watch;               /* on the shown scene's files; NULL: not possible */
    struct watch *watch_asked;         /* on `asked`, until that is shown; likewise */
    char asked[SETTING_PATH_BYTES];    /* what was opened, or read again, last */
    char refused[ENGINE_MESSAGE];      /* why that is not shown; "": it is, or may be yet */
    char answered[SETTING_PATH_BYTES]; /* the last folder of status.refused that the user was asked
                                          about */
    uint32_t reloads;                  /* that there were, of any scene */
    bool played;                       /* the shown scene, before another one was asked for */
    struct replay *replay;
    FILE *record;
    double record_ms;
    char shot[EVENT_PATH]; /* of the next drawing; "": none */
};

/* The viewer's clock in ms: the system's, or the one that a replay turns. Only figures of measured
   time read the system's clock in a replay. */
double view_now_ms(const struct view *view);
/* Says something for some seconds. */
void view_say(struct view *view, const char *format, ...) WHIT_PRINTF(2, 3);
/* The settings changed: draw them. */
void view_changed(struct view *view);
/* The camera was moved by hand: its text, and quick pictures for a moment. */
void view_moved(struct view *view);
/* Whether quick pictures are wanted, as more will follow. */
/* `settings`, with the samples of the picture that is shown where that is refined. */
struct settings view_drawn(const struct view *view, const struct settings *settings);
bool view_is_moving(const struct view *view);
/* When that ends, where nothing is moved any more. */
double view_stands_ms(const struct view *view);
/* To what the picture shows, where another kernel or other trees were asked for and are not there
   as yet; false where they were not. */
bool view_go_back(struct view *view);
/* The animation goes on by itself, and there is one. */
bool view_plays(const struct view *view);
/* Another scene, as the file dropped on the window. Keeps all but camera and time, which stands. */
void view_open(struct view *view, const char *path);
/* scenes.c: the scene that is shown, and the one that is asked for. */
void scenes_begin(struct view *view);
void scenes_end(struct view *view);
/* The new picture is of another scene. */
void scenes_show(struct view *view);
/* What is asked for failed: says so, once for one error, and goes back to what is shown. False
   where it is the shown scene that failed. */
bool scenes_refuse(struct view *view);
/* What was refused is no longer of interest. */
void scenes_forget(struct view *view);
/* The folder that the scene may read if the user says so; NULL: there is nothing to ask. */
const char *scenes_question(const struct view *view);
/* Ends the question; where `allow`, reads the scene again with that folder. */
void scenes_answer(struct view *view, bool allow);
/* Reads what was written. */
void scenes_watch(struct view *view);
/* Reads what was refused, else what is shown, again. */
void scenes_read_again(struct view *view);
/* The settings, unless they are of a scene that is not shown yet: then the last picture's. */
const struct settings *scenes_shown(const struct view *view);
/* What the engine could not do, an error a line; and the same for the log. */
const char *view_failure(const struct view *view);
void view_log_failure(const struct view *view);
/* What went wrong, an error a line; "": nothing. */
const char *view_error(const struct view *view);
/* Sets the camera of the scene with this index; -1: the text of the settings. */
void view_use_camera(struct view *view, int index);
/* The world's bounds of the scene; false where none is loaded, or it is empty. */
bool view_bounds(const struct view *view, double lo[3], double hi[3]);
double view_aspect(const struct view *view);
/* The camera as numbers, of what the settings' text says. */
void view_learn_camera(struct view *view);

/* pick.c: the pixel at a place of the window. */
void pick_at(struct view *view, double x, double y);
/* Looks at what is under the mouse. */
void pick_focus(struct view *view);
/* What came of it. */
void pick_take(struct view *view);
/* The panel, and the pixel's rays in the scene. */
void pick_draw(struct view *view);

/* price_panel.c: the prices of this view, asked for or no more. */
void price_switch(struct view *view);
void price_draw(struct view *view);
/* Stops it; it goes once it is at its end, which nobody waits for. NULL is fine. */
void prices_leave(struct view *view, struct prices *prices);
void prices_part(struct view *view); /* from those that are */

/* overlay.c: lines in the scene, between ui_begin and ui_end. Cameras that are not perspective have
   none. */
bool overlay_is_possible(const struct view *view);
void overlay_line(const struct view *view, const double a[3], const double b[3], uint32_t color,
                  float width);
void overlay_boxes(const struct view *view);

/* input.c */
void input_event(struct view *view, const struct view_event *event);
/* Obeys keys that are held, and the animation; true where something moves on by itself. */
bool input_step(struct view *view, double now_ms);

/* keys.c: what keys do, with the state of it. */
/* Of the cheat sheet, in its order. */
enum key_group { KEYS_CAMERA, KEYS_PICTURE, KEYS_FILES, KEYS_EXPERTS, KEY_GROUPS };

struct key_binding {
    int key;
    unsigned mods;
    const char *keys;  /* as the cheat sheet says them; NULL: they are in another row of it */
    const char *title; /* what it says of them; NULL: the name */
    const char *name;  /* of the state */
    void (*act)(struct view *view);
    void (*state)(const struct view *view, char *text, size_t bytes); /* NULL: none */
    const struct setting *setting; /* that it turns, in place of `act` and `state`; NULL: none */
    int by;
    enum key_group group;
};
const struct key_binding *key_bindings(uint32_t *count);
/* False where there is nothing to say. */
bool key_state(const struct view *view, const struct key_binding *key, char *text, size_t bytes);
/* False where the key does nothing. */
bool key_act(struct view *view, int key, unsigned mods);

/* measure.c */
void measure_begin(struct view *view);
/* The window was drawn just now, with `view->frame`. */
void measure_shown(struct view *view);
double figures_quantile(struct view_figures *figures, double share); /* sorts; 0: of none */

/* hud.c: everything drawn over the picture, between ui_begin and ui_end. */
void hud_draw(struct view *view);

/* state.c: the line of JSON that tests read, with its name; the measure begins anew. */
void state_print(struct view *view, const char *name, FILE *to);
/* Whether the line would have FIELD = VALUE, or a FIELD that is neither empty, false nor 0. */
bool state_has(struct view *view, const char *condition);

/* replay.c */
WHIT_CHECK whit_result replay_open(struct view *view);
/* Feeds what is due, and turns the clock. */
void replay_step(struct view *view);
/* Until its next event is due; HUGE_VAL without one. */
double replay_wait_s(struct view *view);
bool replay_is_over(const struct view *view);
void replay_close(struct view *view);
void record_event(struct view *view, const struct view_event *event);

#endif

/* The viewer from inside: shared by the files of view/ that draw and act. */
#ifndef VIEW_VIEW_PRIVATE_H
#define VIEW_VIEW_PRIVATE_H

#include "device/swapchain.h"
#include "view/camera.h"
#include "view/compare.h"
#include "view/hud.h"
#include "view/input.h"
#include "view/measure.h"
#include "view/panels.h"
#include "view/shaders.h"
#include "view/ui.h"
#include "view/view.h"
#include "view/window.h"
#include "view/wish.h"

enum { TOAST_BYTES = 256, LEAVING_MAX = 4 };

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
    float pick_place[3];       /* where the panel of the pixel was last: x, y, height */
    bool picked;               /* its panel is open */
    double pick_x, pick_y;     /* the pixel that was asked for last */
    uint64_t pick_frame;       /* number of the picture that it was asked of by itself */
    bool focus;                /* look at it when it is there */
    struct scene_ref *scene;   /* of `frame` */

    struct prices *prices;               /* NULL: none are asked for */
    struct prices *leaving[LEAVING_MAX]; /* stopped, and not at their end as yet */
    struct wish wish;
    bool prices_open;

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
/* `settings`, with the samples of the picture that is shown where that is refined. */
struct settings view_drawn(const struct view *view, const struct settings *settings);
/* Whether quick pictures are wanted, as more will follow. */
bool view_is_moving(const struct view *view);
/* When that ends, where nothing is moved any more. */
double view_stands_ms(const struct view *view);
/* To what the picture shows, where another kernel or other trees were asked for and are not there
   as yet; false where they were not. */
bool view_go_back(struct view *view);
/* The animation goes on by itself, and there is one. */
bool view_plays(const struct view *view);
/* What the engine could not do, an error a line; and the same for the log. */
const char *view_failure(const struct view *view);
void view_log_failure(const struct view *view);
/* What went wrong, an error a line; "": nothing. */
const char *view_error(const struct view *view);
/* The world's bounds of the scene; false where none is loaded, or it is empty. */
bool view_bounds(const struct view *view, double lo[3], double hi[3]);
double view_aspect(const struct view *view);

#endif

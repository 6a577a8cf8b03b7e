/* The inside of the viewer: shared by the files of view/ that draw and act. */
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

struct view_clock { /* time of the animation */
    bool playing, once;
    double speed, last_ms;
};

/* A picture that takes longer than this shows a progress bar. */
#define SLOW_MS 700.0

/* The frame rate of the last pictures, for the HUD. */
struct view_rate {
    double shown_ms[32]; /* ring buffer, since the last pause */
    uint32_t count;
    double fps; /* 0: not known after one picture alone */
};

/* The viewer's clock: it says how long messages stay, when a moved picture is at rest, and how far
   an animation is. A replay moves it by its lines `wait`, so that the load of the machine changes
   nothing. */
struct view_time {
    bool turned;
    double now_ms;   /* the time, while a replay moves the clock (`turned`) */
    double ahead_ms; /* not `turned`: how far the time is ahead of the system's clock */
};

struct view {
    whit_log log;
    const struct view_params *params;
    struct window *window;
    struct device *device;
    struct swapchain *swapchain;
    struct ui *ui;
    struct engine *engine;

    struct settings settings; /* the settings that are asked for */
    /* The settings of the last picture, or at the start: a failed request goes back to them. */
    struct settings fallback;
    struct view_camera camera; /* settings.camera as numbers */
    bool camera_known;         /* false: the scene's camera was not read yet */
    int file_camera;           /* index of the scene's camera; -1: moved by hand */
    double camera_time_s;      /* at which `camera` is that of the scene */

    struct engine_frame frame;
    struct engine_status status;
    struct engine_probe probe; /* the picked pixel; number 0: none */
    struct pick_place {
        float x, y, height;
    } pick_place;            /* last place of its panel, as ui_window_begin takes it */
    bool picked;             /* the panel of the pixel is open */
    double pick_x, pick_y;   /* the pixel that was asked for last */
    uint64_t pick_frame;     /* number of the picture for which it was last asked again */
    bool focus;              /* the camera frames the hit once the probe is there */
    struct scene_ref *scene; /* scene of `frame` */

    struct prices *prices;               /* NULL: none are measured */
    struct prices *leaving[LEAVING_MAX]; /* told to stop, not ended yet */
    struct wish wish;
    bool prices_open;
    unsigned open; /* the opened panels when the window was last drawn: hud.c */
    struct view_crowd {
        bool low; /* the window has no room for figures beside its opened panels */
        unsigned open;
        uint32_t hud, width, height;
    } crowd;

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
    bool unasked;    /* since then, the engine was not asked for a picture */
    double drawn_ms; /* when the window was last drawn */
    double escape_ms;
    enum view_hud hud;
    bool help, hint;
    char toast[TOAST_BYTES];
    double toast_until_ms;
    double progress_ms; /* when the progress bar was last drawn, by the system's clock */
    bool dirty;         /* the window has to be drawn again, as what it shows has changed */
    bool unsettled;     /* or for its panels alone: ui_wants_again */
    bool resized;       /* the images of the window have to be made again */
    bool quit;
    uint32_t shown; /* number of pictures shown */
    bool picture_set;

    struct watch *watch;            /* watches the shown scene's files; NULL: not possible */
    struct watch *watch_asked;      /* watches `asked` until it is shown; NULL: not possible */
    char asked[SETTING_PATH_BYTES]; /* the scene that was last opened, or read again */
    char told[SETTING_PATH_BYTES];  /* the scene that view_params.tell was called for last */
    char refused[ENGINE_MESSAGE];   /* why `asked` is not shown; "": it is, or may still be */
    /* The last folder of status.refused that the user has answered about. */
    char answered[SETTING_PATH_BYTES];
    uint32_t reloads; /* number of reloads, of any file */
    bool played;      /* the shown scene played before another one was asked for */
    struct replay *replay;
    FILE *record;
    double record_ms;
    char shot[EVENT_PATH]; /* file for a picture of the next drawing; "": none */
};

/* The viewer's clock in ms: the system's, or the one that a replay moves. In a replay only measured
   times use the system's clock. */
double view_now_ms(const struct view *view);
/* Shows a message for some seconds. */
void view_say(struct view *view, const char *format, ...) WHIT_PRINTF(2, 3);

/* A file that is being saved. The log that view_saving_begin gives goes on to the viewer's, and
   keeps the last error for the message of view_say_saved in the window. */
struct view_saving {
    whit_log next;
    char error[TOAST_BYTES];
};
whit_log view_saving_begin(const struct view *view, struct view_saving *saving);
void view_say_saved(struct view *view, const struct view_saving *saving, const char *path,
                    bool saved);
/* Call it when the camera was moved by hand: updates its text, and asks for quick pictures for a
   while. */
void view_moved(struct view *view);
/* Gives `settings`, with the number of samples of the shown picture if that is refined. */
struct settings view_drawn(const struct view *view, const struct settings *settings);
/* Writes the `whit render` line that makes the shown picture. VIEW_LINE has room for the longest
   paths, each byte of them quoted as \xNN. */
enum { VIEW_LINE = 1 << 16 };
void view_line(const struct view *view, char line[VIEW_LINE]);
/* Whether the window has to be drawn again. */
bool view_is_stale(const struct view *view);
/* Whether quick pictures are wanted, since something moves. */
bool view_is_moving(const struct view *view);
/* When quick pictures end if nothing is moved any more, by view_now_ms. */
double view_stands_ms(const struct view *view);
/* Goes back to the settings of the shown picture if another kernel or tree was asked for and is not
   there yet; false: it was not. */
bool view_go_back(struct view *view);
/* Whether an animation is playing. */
bool view_plays(const struct view *view);
/* The errors of the engine's last failure, one a line; the second function logs them. */
const char *view_failure(const struct view *view);
void view_log_failure(const struct view *view);
/* The errors to show, one a line; "": none. */
const char *view_error(const struct view *view);
/* The bounds, in world space, of what Home shows; false: no scene is loaded, or it is empty. */
bool view_bounds(const struct view *view, double lo[3], double hi[3]);
double view_aspect(const struct view *view);

#endif

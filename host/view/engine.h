/* Draws beside the window: one thread draws what was last asked for, another makes new sessions
   while the old one goes on drawing. The window's thread asks and takes; no call of it waits. */
#ifndef VIEW_ENGINE_H
#define VIEW_ENGINE_H

#include "base/sample.h"
#include "view/difference.h"
#include "view/session.h"
#include "whit/whit_program.h"

struct engine;

struct engine_params {
    double budget_ms;         /* of a picture while something moves; 0: 1000 / 30 */
    bool refine, times;       /* see engine_set_rest */
    uint32_t sessions;        /* kept at a time, 2..8; 0: 4 */
    void (*wake)(void *user); /* from any thread: there is something to take. May be NULL. */
    void *wake_user;
    whit_shader_compiler *compiler; /* of settings.shader, whose log is silent; NULL: none */
    whit_log log; /* from any thread: what the validation layers say. May be silent */
};

WHIT_CHECK whit_result engine_create(const struct engine_params *params, struct engine **out);
/* Cancels, waits; NULL is fine. How many messages the validation layers had of its devices. */
uint32_t engine_destroy(struct engine *engine);

/* Another budget from now on. */
void engine_set_budget(struct engine *engine, double budget_ms);

/* What to draw from now on. `moving`: more will follow soon, so be quick: a smaller picture of one
   sample within the budget; else as the settings say, a quick one first. */
void engine_ask(struct engine *engine, const struct settings *settings, bool moving);

/* What B of the split view shows: `settings` are drawn too, at the place of the last picture of
   what engine_ask says. NULL: no more. */
void engine_ask_other(struct engine *engine, const struct settings *settings);

enum { ENGINE_MESSAGE = 512, ENGINE_BOXES_MAX = 8192 };

/* By how much a picture of so many samples may be off, and how long it took to draw. */
struct engine_estimate {
    uint32_t samples;
    double error; /* RMSE, as whit_refine_info.error */
    double ms;    /* since its first sample was begun, of drawing alone */
};
enum { ENGINE_ESTIMATES_MAX = 16 };

/* A picture that is done, or with an error in its place. */
struct engine_frame {
    uint64_t number;           /* counts up; 0: none yet */
    uint64_t first;            /* number of the first picture of what was asked for */
    struct settings settings;  /* drawn */
    struct scene_ref *scene;   /* held */
    struct shader_ref *shader; /* held; NULL: none */
    whit_image *color;         /* floats: linear RGBA, or of one channel where costs are painted */
    whit_image *plain;         /* `color` without edges and grid; NULL where it has none */
    whit_image *ids;           /* hit identities; NULL but for pictures of all pixels */
    whit_image *cuts;          /* WHIT_AOV_CUTS of pictures that more samples are added to, else
                                  NULL */
    uint8_t *rgba;             /* width * height * 4: as the window shows it */
    uint32_t width, height, divisor; /* the window's size is divided by `divisor` */
    uint32_t samples;                /* a pixel; adaptive: 0 */
    bool refined;                    /* of other samples than the settings say; without ids, these
                                        and boxes are those of the picture before */
    struct engine_estimate estimates[ENGINE_ESTIMATES_MAX]; /* while it was refined */
    uint32_t estimate_count;
    bool whole;           /* full size and all samples: what `whit render` makes */
    bool moving;          /* more was to follow */
    double asked_ms;      /* by whit_clock_ms: when engine_ask first asked for it */
    double draw_ms;       /* by the clock: all of it, with reading it back; at once, not in steps */
    double scale;         /* of a heat map */
    whit_box *boxes;      /* of settings.boxes: at most ENGINE_BOXES_MAX */
    uint64_t boxes_total; /* that there are */
    whit_stats stats;
    double visits;        /* nodes opened, of a camera ray on average; < 0: not known */
    uint64_t visits_rays; /* that it is of */
    whit_accel_info accel;
    whit_device_info device;
    double build_ms, compile_ms;
    uint64_t made, kernels; /* session.made; kernels that its driver was asked for by now */
    uint64_t effects;       /* a bit for each that is compiled, in the order of whit_effect_name */
};
void engine_frame_finish(struct engine_frame *frame);
/* Moves hits and boxes of the picture before to one that is refined and has none of its own. */
void engine_frame_inherit(struct engine_frame *before, struct engine_frame *refined);
/* The time of drawing in ms, without presenting: on the device where that is measured. */
double engine_drawn_ms(const whit_stats *stats);

/* What another kernel, tree or setting changed, from the last whole picture before to the first one
   after, of the same place. */
struct engine_change {
    uint64_t number;          /* counts up; 0: none yet */
    struct settings settings; /* after it */
    char what[128];           /* "traversal distance -> sign" */
    struct difference difference;
    double before_ms, after_ms; /* of drawing, on the device where it measures: of one picture each,
                                   or the medians of `ms` */
    struct sample_median ms;    /* by how much it takes longer, of pairs that were drawn in turns;
                                   count 0: not measured */
    bool over;                  /* nothing more will be known */
};

/* What a new version of the shader makes of the window's picture, beside the version before. Both
   are still there: what is not known at once is measured while nothing else is to be done. */
struct engine_reload {
    uint64_t number;          /* counts up; 0: none yet */
    struct settings settings; /* of the first whole picture after it */
    bool compared;   /* with the last whole picture before, as all other settings are equal */
    bool has_colors; /* both are of colours */
    struct difference difference;
    bool has_flip; /* `flip`: the mean over all pixels */
    double flip;
    bool over;               /* nothing more will be known */
    struct sample_median ms; /* by how much a whole picture takes longer, of pairs that were drawn
                                in turns; count 0: not measured */
    const char *why;         /* it was not; "": it was, or may be yet */
};

struct engine_status {
    enum session_stage stage;         /* of the session in the making; SESSION_DONE: none is */
    double stage_ms;                  /* since it was asked for */
    bool makes_spare;                 /* a session is in the making that the next version of the
                                         shader will take; no `stage` tells of it */
    bool drawing;                     /* a better picture than the last one is on its way */
    double drawing_ms;                /* that the drawing thread is at one; 0: it is at none */
    float part;                       /* of it, 0..1 */
    char error[ENGINE_MESSAGE];       /* the last failure, until something succeeds; "": none */
    char errors[SESSION_ERRORS];      /* as session.errors, of `error` */
    char refused[SETTING_PATH_BYTES]; /* as session.refused, of the scene that was loaded last */
    bool failed;        /* what was asked for last cannot be drawn: `error` says why */
    whit_result result; /* of `error`; once there is none any more, of the last one */
    bool device_lost;
    struct engine_change change; /* the last one */
    struct engine_reload reload; /* likewise */
};
void engine_get_status(struct engine *engine, struct engine_status *status);

/* Moves the newest picture into *frame, whose old one is finished; false when there is no newer one
   than frame->number. `other`: that of engine_ask_other. */
bool engine_take(struct engine *engine, bool other, struct engine_frame *frame);

/* The window's picture of this number is on the screen: what is drawn next may take all cores. */
void engine_note_shown(struct engine *engine, uint64_t number);

/* The ray tree of a pixel of the window's whole picture. */
struct engine_probe {
    uint64_t number;           /* counts up; 0: none yet */
    struct settings settings;  /* of the picture */
    struct scene_ref *scene;   /* held */
    whit_probe_report *report; /* NULL where it failed: see engine_status.error */
    whit_probe_row *rows;      /* of the report */
    uint32_t row_count;
    double ms;
};
void engine_probe_finish(struct engine_probe *probe);
/* Traces the pixel, counted from the upper left, as soon as the picture is whole; the last one
   asked for counts. */
void engine_ask_probe(struct engine *engine, uint32_t x, uint32_t y);
/* As engine_take. */
bool engine_take_probe(struct engine *engine, struct engine_probe *probe);

/* Measures what is not known of the last reload, whenever there is nothing else to do. */
void engine_measure_reload(struct engine *engine);
/* Something else comes first: what is not known of a reload by now will not be measured. */
void engine_stop_reload(struct engine *engine);

/* True when nothing is left to do: the whole picture of what was last asked for was taken, or there
   is an error, and memory that is free was given back. Never while something moves. */
bool engine_is_still(struct engine *engine);

/* What is done at rest, once a picture was taken. `refine`: it gets 4, 16, 64 ... times the samples
   of the settings, until hardly a displayed pixel changes (engine_refine.c says how few). `times`:
   the last change is measured. */
void engine_set_rest(struct engine *engine, bool refine, bool times);
/* True when both have come to their end, or cannot begin. */
bool engine_is_refined(struct engine *engine);

/* Waits for the next thing to take, at most `ms`. For tests and replays. */
void engine_wait(struct engine *engine, double ms);

/* The function of the frame's shader that settings.aov names; UINT32_MAX: there is none. */
uint32_t engine_find_aov(const struct engine_frame *frame);

#endif

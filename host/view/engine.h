/* Draws for the window: one thread draws what was last asked for, another makes new sessions while
   the old one goes on drawing. The window's thread asks and takes; none of its calls waits. */
#ifndef VIEW_ENGINE_H
#define VIEW_ENGINE_H

#include "base/sample.h"
#include "base/watch.h"
#include "view/difference.h"
#include "view/session.h"
#include "whit/whit_program.h"

struct engine;

struct engine_params {
    double budget_ms;         /* time for a picture while something moves; 0: 1000 / 30 */
    bool refine, times;       /* see engine_set_rest */
    bool time_stages;         /* see engine_time_stages */
    void (*wake)(void *user); /* called from any thread: something can be taken. May be NULL */
    whit_shader_compiler *compiler; /* for settings.shader; its log is silent. NULL: no shaders */
    whit_log log; /* called from any thread, for the validation layers; may be silent */
};

WHIT_CHECK whit_result engine_create(const struct engine_params *params, struct engine **out);
/* Cancels and waits; NULL is fine. Returns the number of messages that the validation layers had
   about its devices. */
uint32_t engine_destroy(struct engine *engine);

/* Sets another budget_ms. */
void engine_set_budget(struct engine *engine, double budget_ms);

/* Says whether the stages of pictures are timed, which takes up to a tenth of their time. If they
   are, and those of the window's picture were not, it is drawn once more. */
void engine_time_stages(struct engine *engine, bool on);

/* Says what to draw from now on. `moving`: more requests will follow soon, so a smaller picture of
   one sample is drawn within the budget. Otherwise the picture is as the settings say, after a
   quick one. */
void engine_ask(struct engine *engine, const struct settings *settings, bool moving);

/* Says what side B of a comparison shows: `settings` are drawn too, with camera, time and size of
   the window's last picture. NULL: there is no B any more. */
void engine_ask_other(struct engine *engine, const struct settings *settings);

enum { ENGINE_MESSAGE = 512, ENGINE_BOXES_MAX = 8192 };

/* The estimated error of a picture of so many samples, and how long it took to draw. */
struct engine_estimate {
    uint32_t samples;
    double error; /* RMSE, as whit_refine_info.error */
    double ms;    /* time of drawing alone, since its first sample */
};
enum { ENGINE_ESTIMATES_MAX = 16 };

/* A picture that was drawn. */
struct engine_frame {
    uint64_t number;                 /* counts up; 0: none yet */
    uint64_t first;                  /* number of the first picture of the same request */
    struct settings settings;        /* settings that it was drawn with */
    struct scene_ref *scene;         /* the frame holds a reference */
    struct shader_ref *shader;       /* likewise; NULL: none */
    whit_image *color;               /* floats: linear RGBA, or costs in one channel */
    whit_image *plain;               /* `color` without edges and grid; NULL: they are not drawn */
    whit_image *ids;                 /* hit identities; NULL unless all pixels were drawn */
    whit_image *cuts;                /* WHIT_AOV_CUTS; NULL unless more samples may be added */
    uint8_t *rgba;                   /* width * height * 4 bytes, as displayed */
    uint32_t width, height, divisor; /* the window's size over `divisor` */
    double
        bailout; /* with which it was drawn: more than its settings have while the camera moves */
    uint32_t samples; /* samples a pixel; adaptive: 0 */
    /* It has another number of samples than the settings say. Without `ids`, ids and boxes are
       those of the picture before (engine_frame_inherit). */
    bool refined;
    struct engine_estimate estimates[ENGINE_ESTIMATES_MAX]; /* errors while samples were added */
    uint32_t estimate_count;
    bool whole;           /* full size and all samples, as `whit render` makes it */
    bool moving;          /* asked for as `moving` */
    double asked_ms;      /* by whit_clock_ms: when the picture was first asked for */
    double draw_ms;       /* wall time with reading back, as if drawn without steps */
    double scale;         /* scale of a heat map */
    whit_box *boxes;      /* those that settings.boxes asks for, ENGINE_BOXES_MAX at most */
    uint64_t boxes_total; /* number of all boxes */
    whit_stats stats;     /* of one sample where samples were added by refining */
    whit_stats all;       /* if `refined`: of all samples */
    double visits;        /* mean nodes that a camera ray opens; < 0: not known */
    uint64_t visits_rays; /* number of rays in this mean */
    whit_accel_info accel;
    whit_device_info device;
    double build_ms, compile_ms;
    uint64_t made, kernels; /* session.made; pipelines made by its driver so far */
    uint64_t effects;       /* a bit for each compiled effect, in the order of whit_effect_name */
};
void engine_frame_finish(struct engine_frame *frame);
/* Moves ids and boxes of the picture before to a refined one that has none of its own. */
void engine_frame_inherit(struct engine_frame *before, struct engine_frame *refined);
/* Time of drawing in ms, without presenting: device time if that is measured. */
double engine_drawn_ms(const whit_stats *stats);

/* The effect of a change of kernel, tree or setting: the difference from the last whole picture
   before it to the first whole one after it, with the same camera, time and size. */
struct engine_change {
    uint64_t number;          /* counts up; 0: none yet */
    struct settings settings; /* settings after the change */
    char what[256];           /* "traversal distance -> sign" */
    bool has_colors;          /* both pictures show colours */
    struct difference difference;
    /* engine_drawn_ms of one picture each, or the medians of the pictures in `ms`. */
    double before_ms, after_ms;
    /* Time by which drawing takes longer, from pairs of pictures drawn in turns; count 0: not
       measured. */
    struct sample_median ms;
    bool over; /* nothing more will be measured */
};

/* The effect of a new version of the shader on the window's picture, compared with the version
   before. Sessions of both are kept: figures that are not known at once are measured while there is
   nothing else to do. */
struct engine_reload {
    uint64_t number;          /* counts up; 0: none yet */
    struct settings settings; /* settings of the first whole picture after it */
    /* `difference` is known: all other settings equal those of the last whole picture before. */
    bool compared;
    bool has_colors; /* both pictures show colours */
    struct difference difference;
    bool has_flip; /* `flip`: the mean over all pixels */
    double flip;
    bool over;    /* nothing more will be measured */
    bool stopped; /* something else was asked for before that */
    /* Time by which a whole picture takes longer, from pairs drawn in turns; count 0: not
       measured. */
    struct sample_median ms;
    const char *why; /* why it was not measured; "": it was, or may still be */
};

struct engine_status {
    enum session_stage stage; /* of the session being made; SESSION_DONE: none is */
    double stage_ms;          /* time since that session was asked for */
    /* A spare session is being made, for the next version of the shader; `stage` does not show
       it. */
    bool makes_spare;
    bool drawing;                /* a better picture than the last one is being drawn */
    double drawing_ms;           /* time spent so far on the current picture; 0: there is none */
    float part;                  /* share of the current picture that is done, 0..1 */
    char error[ENGINE_MESSAGE];  /* the last failure, until something succeeds; "": none */
    char errors[SESSION_ERRORS]; /* as session.errors, all that belongs to `error` */
    char refused[SETTING_PATH_BYTES]; /* as session.refused, for the scene that was loaded last */
    bool failed;        /* the last request cannot be drawn; the reason is in `error` */
    whit_result result; /* result of the last failure, also after `error` was cleared */
    bool device_lost;
    struct engine_change change; /* the last change */
    struct engine_reload reload; /* the last reload */
};
void engine_get_status(struct engine *engine, struct engine_status *status);

/* Watches the files of the last scene that could not be shown, as far as it named them. */
void engine_watch_unread(struct engine *engine, struct watch *watch);

/* Moves the newest picture into *frame, whose old contents are freed; false: there is no newer one
   than frame->number. `other`: the picture for engine_ask_other. */
bool engine_take(struct engine *engine, bool other, struct engine_frame *frame);

/* Call it when the window's picture of this number is on the screen: drawing may then use all
   cores. */
void engine_note_shown(struct engine *engine, uint64_t number);

/* The ray tree of a pixel of the window's whole picture. */
struct engine_probe {
    uint64_t number;           /* counts up; 0: none yet */
    struct settings settings;  /* settings of the picture */
    struct scene_ref *scene;   /* the probe holds a reference */
    whit_probe_report *report; /* NULL: probing failed, see engine_status.error */
    whit_probe_row *rows;      /* rows of the report */
    uint32_t row_count;
    double ms;
};
void engine_probe_finish(struct engine_probe *probe);
/* Traces the pixel, counted from the upper left, as soon as the picture is whole. A later request
   replaces an earlier one. */
void engine_ask_probe(struct engine *engine, uint32_t x, uint32_t y);
/* Takes the newest probe, as engine_take does pictures. */
bool engine_take_probe(struct engine *engine, struct engine_probe *probe);

/* Measures what is not known about the last reload, when there is nothing else to do. */
void engine_measure_reload(struct engine *engine);
/* Call it when something else comes first: what is not known about the last reload will not be
   measured. */
void engine_stop_reload(struct engine *engine);

/* Whether nothing is left to do: the whole picture of the last request was taken, or failed, and
   free memory was given back. It is false while something moves. */
bool engine_is_still(struct engine *engine);

/* Says what is done at rest, after a picture was taken. `refine`: the picture gets 4, 16, 64 ...
   times the samples of the settings, until hardly a displayed pixel changes (engine_refine.c).
   `times`: the effect of the last change on the time of drawing is measured. */
void engine_set_rest(struct engine *engine, bool refine, bool times);
/* Whether both are finished, or cannot begin. */
bool engine_is_refined(struct engine *engine);

/* Waits until a picture or something else can be taken, at most `ms`. For tests and replays. */
void engine_wait(struct engine *engine, double ms);

#endif

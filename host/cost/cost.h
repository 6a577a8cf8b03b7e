/* Time and error of each setting of each knob in one scene and picture.

   Times are measured in turns with the usual settings, in pictures of price.width x price.height,
   which are as large as the time allows. What is measured is the ratio; milliseconds are this ratio
   times those of the usual picture at full size. Errors are differences to the reference in double,
   in pictures of report->judged_width x judged_height. */
#ifndef COST_COST_H
#define COST_COST_H

#include "cost/knobs.h"
#include "cost/price.h"

/* ---- Effects (effects.c) ---- */

struct cost_effect {
    bool compiled;           /* the usual picture has the effect; switching takes it out, else in */
    bool priced;             /* the fields below are set */
    enum cost_clock clock;   /* clock by which price.verdict was made */
    struct cost_price price; /* `setting`: the picture with the effect switched */
    whit_difference error;   /* between the picture with the effect switched and the usual one */
};
struct cost_effects {
    const whit_scene *scene;
    whit_device *device;
    whit_accel *accel;
    whit_renderer *usual;               /* has rendered once */
    const whit_renderer_params *params; /* params of `usual` */
    bool added;                         /* also price effects that the usual picture lacks */
    uint32_t rounds;
    const whit_log *log;
    /* Called before each effect that is priced, with the share of work done, 0..1. Any result but
       WHIT_OK stops the measurement. */
    whit_result (*begin)(void *user, double done, const char *name);
    /* Called for each effect, priced or not; `index` is that of whit_effect_name. */
    void (*found)(void *user, uint32_t index, const struct cost_effect *effect);
    void *user;
};
/* How many effects will be priced. */
uint32_t cost_effects_count(const struct cost_effects *request);
WHIT_CHECK whit_result cost_effects_measure(const struct cost_effects *request);

/* The two sets of rays whose hits are judged: rays of the camera, and rays aimed at vertices, edges
   and triangles. */
enum cost_set { COST_CAMERA, COST_AIMED, COST_SETS };
const char *cost_set_name(enum cost_set set); /* "picture" */
struct cost_hits {
    bool traced, unanswered; /* unanswered: the device reported that its hits cannot be trusted */
    double ms;               /* for all rays: the device's clock, or else the wall clock */
    whit_judgement judged;
};

enum { COST_NAME = 96, COST_NOTE = 160 };
struct cost_row {
    char knob[32], setting[32], option[COST_NAME];
    uint32_t knob_index, setting_index; /* WHIT_NONE: the usual picture, or a combination */
    enum setting_change change;
    bool measured;        /* price and errors are set */
    char note[COST_NOTE]; /* why it was not measured, or what is wrong with it; or "" */
    struct cost_price price;
    double ms[COST_CLOCKS]; /* for the full picture; device < 0: not measured */
    double ms_low, ms_high; /* 95 % interval, by the report's clock, from that of the ratio */
    double build_ms;        /* to build its trees; < 0: uses the usual trees */
    whit_difference error;  /* to the reference with reference_samples */
    whit_difference alone;  /* to the reference with one sample; pixel_count 0: not
                               compared, since the setting changes samples */
    uint64_t pixels_changed, ids_changed; /* from the usual picture, at the judged size */
    uint64_t non_finite;
    bool broken; /* a defect: `change` is SETTING_COST, but pixels or ids changed */
    struct cost_hits hits[COST_SETS];
    bool best;           /* in the Pareto set: no measured row is faster and as right; false for
                            settings that change hits where no rays were traced */
    whit_image *picture; /* at the judged size, or NULL */
    whit_image *flip;    /* its FLIP map to the reference, or NULL */
};

/* A goal of cost_choose: settings under a limit of error, or within a limit of time in ms. */
enum cost_goal_kind { COST_UNDER, COST_WITHIN };
enum cost_metric { COST_RMSE, COST_FLIP };
const char *cost_metric_name(enum cost_metric metric); /* "rmse" */
enum { COST_GOALS_MAX = 5 };
struct cost_goal {
    enum cost_goal_kind kind;
    enum cost_metric metric;
    double limit;
    bool edges; /* COST_WITHIN: the caller gives edges more samples in the time that is left, so
                   fewer samples of all pixels are enough */
    double of_usual; /* > 0: `limit` is set to about this many times the usual picture's time, and
                        reports do not mention it where no settings keep it */
};
struct cost_answer {
    struct cost_goal goal;
    bool found, kept; /* kept: the limit holds in the measured row */
    uint32_t row;     /* the row that measured the choice, or WHIT_NONE */
    double ms, error; /* predicted */
};

enum { COST_ROWS_MAX = 64, COST_ABSENT_MAX = 64, COST_KNOBS_ALL = 0 };
struct cost_absent {
    char name[64], why[64];
};

struct cost_report {
    uint32_t width, height, judged_width, judged_height;
    uint32_t reference_samples, reference_depth, reference_light_samples;
    double reference_ms[2]; /* with one sample, with reference_samples; 0: read from the cache */
    bool reference_cached[2];
    enum cost_clock clock;
    bool complete; /* false: stopped early, and some rows were not measured */
    double spent_ms;
    char device[256], driver[256];
    whit_device_kind kind;
    whit_load_path load_path;
    uint64_t scene_hash;
    uint32_t row_count; /* row 0: the usual settings */
    struct cost_row rows[COST_ROWS_MAX];
    uint32_t absent_count;
    struct cost_absent absent[COST_ABSENT_MAX];
    double usual_ms_max; /* 90 % quantile of the usual picture's time at full size, wall clock */
    double small_ms;     /* usual picture's time at cost_small_size, by `clock` */
    uint32_t answer_count;
    struct cost_answer answers[COST_GOALS_MAX];
    whit_image *reference; /* picture with reference_samples, or NULL */
};

struct cost_request {
    whit_device *device;
    const whit_scene *scene;
    whit_accel *accel;               /* of the usual settings; is set to the picture's time */
    const struct settings *settings; /* everything that knobs do not set */
    const volatile bool *cancel;
    double end_ms;        /* of whit_clock_ms: all measurements end by then, strict; 0: no limit */
    uint64_t knobs;       /* knobs to measure, as bits by index in knob_table; 0: all */
    double seconds;       /* time for all measurements, roughly */
    uint32_t samples_max; /* of the reference: 4, 16 or 64; 0: 64, or 16 for a larger picture */
    /* Least size of the judged picture, unless the whole picture is smaller. */
    uint32_t judged_width_min, judged_height_min;
    uint32_t rays; /* in each set; 0: hits are not judged */
    uint32_t goal_count;
    struct cost_goal goals[COST_GOALS_MAX]; /* each gets a row that measures the choice */
    bool keep_pictures;
    void (*progress)(void *user, double done, double seconds_left, const char *what);
    void (*hush)(bool on); /* silences errors while a device may refuse a setting; or NULL */
    void *progress_user;
    const whit_log *log;
};

/* Makes a report. WHIT_ERROR_CANCELLED where `cancel` stopped it, WHIT_ERROR_TIME_LIMIT where
   end_ms did; *out then has what was measured before. *out is NULL where not even the usual
   settings were measured. */
WHIT_CHECK whit_result cost_measure(const struct cost_request *request, struct cost_report **out);
void cost_report_destroy(struct cost_report *report);
/* Frees the pictures that keep_pictures kept; the figures stay. */
void cost_report_drop_pictures(struct cost_report *report);
/* The size of a small picture whose time shows how fast the device is at this moment. */
void cost_small_size(const struct cost_report *report, uint32_t *width, uint32_t *height);

/* ---- Answers (choose.c) ---- */

/* Predicted time or error may be COST_ROOM of the limit, since figures were measured at another
   moment. A picture that takes less than COST_TOO_LITTLE of its predicted time leaves room for
   better settings. */
#define COST_ROOM       0.9
#define COST_TOO_LITTLE 0.6

double cost_error_of(const whit_difference *difference, enum cost_metric metric);
/* The row's error. Where the reference cannot judge it (cost_is_judged), its sampling error was not
   measured, and counts as at least half that of a quarter of the samples, as for random ones. */
double cost_error_left(const struct cost_report *report, const struct cost_row *row,
                       enum cost_metric metric);

/* A choice of settings, predicted from a report's figures: ratios of time multiply, squared RMSE
   and FLIP add up. COST_UNDER: the cheapest settings with an error of at most `limit`. COST_WITHIN:
   the settings that take at most `limit` ms of wall clock 9 times of 10 and give up least, in the
   order of within.c, with as many samples as fit, up to 64. Knobs that change nothing get their
   fastest setting. Numerics and instances stay as they are, since one picture does not show their
   errors. Rows of knob `aa` count with cost_error_left. */
enum { COST_SAMPLES_MAX = 256 }; /* of COST_UNDER: more than were measured are extrapolated */
struct cost_choice {
    uint8_t settings[KNOBS]; /* by index in knob_table: index of the knob's setting */
    uint32_t samples;        /* per pixel; 0: as the setting of knob `aa` says */
    double contrast;         /* above 0: adaptive by it, up to `samples_max` */
    uint32_t samples_max;
    double ms, error; /* predicted: wall clock at full size; by the goal's metric */
    bool found;
};
struct cost_choice cost_choose(const struct cost_report *report, const struct cost_goal *goal);
/* The choice by RMSE that takes at most COST_ROOM of `budget_ms` 9 times of 10; where there is
   none, one whose median time is within the budget. `edges`: as in cost_goal. */
struct cost_choice cost_choose_budget(const struct cost_report *report, double budget_ms,
                                      bool edges);
void cost_choice_apply(const struct cost_choice *choice, struct settings *settings);
/* Writes the choice as options of `whit render`. */
void cost_choice_text(const struct cost_choice *choice, char *text, size_t text_bytes);

/* The use of a row, compared with the usual settings. NONE: neither cheaper nor more right, by RMSE
   or by FLIP. FREE: cheaper, and at least as right (within 1 %). TRADE: cheaper but less right, or
   more right but not cheaper; a picture in double, which no option draws, is never more. */
enum cost_use { COST_USE_TRADE, COST_USE_NONE, COST_USE_FREE };
enum cost_use cost_use_of(const struct cost_report *report, const struct cost_row *row);

/* ---- Findings at the top of a report (findings.c) ---- */

/* Names the report's clock: "time" by the wall clock, "processor time", "device time". */
const char *cost_time_name(const struct cost_report *report);

/* A sentence without its full stop, and the exact values of the figures in it. */
enum { COST_FINDINGS_MAX = 5, COST_FINDING_VALUES = 4 };
struct cost_finding {
    char text[192];
    uint32_t value_count;
    double values[COST_FINDING_VALUES];
};
/* Fills up to five findings, in this order: how much error more time removes, which bounces are
   visible, what exact hits cost, which setting is cheaper and as right, which effect takes most of
   the time. A finding whose rows were not measured is left out. Gives their number. */
uint32_t cost_findings(const struct cost_report *report,
                       struct cost_finding findings[COST_FINDINGS_MAX]);
/* Writes the first findings as one sentence. */
enum { COST_SENTENCE_BYTES = 1024 };
void cost_sentence(const struct cost_report *report, char text[COST_SENTENCE_BYTES]);

/* ---- One crop at several times (strip.c) ---- */

/* The strip has a crop for 1/4, 1, 4 and 16 times the usual picture's time. */
enum { COST_STRIP = 4 };
struct cost_share {
    double of_usual; /* time as a multiple of the usual picture's */
    uint32_t row;    /* the best picture within that time; WHIT_NONE: no measured one is as quick */
};
/* Adds the goals of the strip to a request, and sets keep_pictures. */
void cost_strip_ask(struct cost_request *request);
void cost_strip(const struct cost_report *report, struct cost_share strip[COST_STRIP]);
/* The most samples of a pixel of the row's picture. */
uint32_t cost_samples(const struct cost_row *row);
/* Whether the reference can judge the row: not if pixels have as many samples as the reference,
   since these are then the very same samples. */
bool cost_is_judged(const struct cost_report *report, const struct cost_row *row);
/* A crop a fifth as wide and high as the judged picture, where the usual picture is most visibly
   wrong. */
struct cost_crop {
    uint32_t x, y, width, height;
};
struct cost_crop cost_crop(const struct cost_report *report);

/* ---- Figures that are kept from one run to the next ---- */

/* The conditions that kept figures were measured under: scene, device, and all settings (size among
   them) that decide pixels or time, except those that cost_choose chooses. */
struct cost_place {
    const struct settings *settings; /* with the limit of time or error */
    whit_scene_info scene;
    whit_device_info device;
};

/* Figures, and the choice that was made by them for settings->budget_ms of their cost_place. */
struct cost_kept_figures {
    struct cost_report report; /* without its reference picture */
    struct cost_choice choice; /* `found` false: none was made yet */
    double choice_ms;          /* time that the choice's picture took, or was predicted to take */
    char made[32];             /* date and time of the measurement, as text */
};

#endif

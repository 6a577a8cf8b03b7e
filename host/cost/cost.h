/* What each setting of each knob costs in one scene and picture, and what it gets wrong: measured
   beside the usual settings, pair by pair, and held against the reference in double.

   Times are of pictures of `timed_width` x `timed_height`, as large as the time allows, and told as
   ratios to the usual settings at that size; milliseconds are these times what the usual picture
   takes at full size. Errors are of pictures of report->judged_width x judged_height. */
#ifndef COST_COST_H
#define COST_COST_H

#include "cost/knobs.h"
#include "cost/price.h"

/* ---- Effects (effects.c) ---- */

struct cost_effect {
    bool compiled;           /* the usual picture has it, and is priced without it; else with it */
    bool priced;             /* what follows is known */
    enum cost_clock clock;   /* that counts */
    struct cost_price price; /* `setting`: the effect is switched */
    whit_difference error;   /* of the picture with the effect switched, to the usual one */
};
struct cost_effects {
    const whit_scene *scene;
    whit_device *device;
    whit_accel *accel;
    whit_renderer *usual;               /* has rendered */
    const whit_renderer_params *params; /* that it was made with */
    bool added;                         /* effects that it lacks are priced too */
    uint32_t rounds;
    const whit_log *log;
    /* Called before each effect that is priced, with what is done, 0..1. Another result than
       WHIT_OK stops. */
    whit_result (*begin)(void *user, double done, const char *name);
    /* Called for each effect there is, by the index of whit_effect_name. */
    void (*found)(void *user, uint32_t index, const struct cost_effect *effect);
    void *user;
};
/* How many effects of the picture can be switched, and are priced. */
uint32_t cost_effects_count(const struct cost_effects *request);
WHIT_CHECK whit_result cost_effects_measure(const struct cost_effects *request);

/* The two sets of rays. */
enum cost_set { COST_CAMERA, COST_AIMED, COST_SETS };
const char *cost_set_name(enum cost_set set); /* "picture" */
struct cost_hits {
    bool traced, unanswered; /* unanswered: the device said that its hits are not to be trusted */
    double ms;               /* of all rays, by the device or the wall clock */
    whit_judgement judged;
};

enum { COST_NAME = 96, COST_NOTE = 160 };
struct cost_row {
    char knob[32], setting[32], option[COST_NAME];
    uint32_t knob_index, setting_index; /* WHIT_NONE: the usual picture, or a combination */
    enum setting_change change;
    bool measured;        /* price and errors are there */
    char note[COST_NOTE]; /* why not, or what is wrong with it; "" */
    struct cost_price price;
    double ms[COST_CLOCKS];               /* of the full picture; device < 0: not measured */
    double ms_low, ms_high;               /* by the report's clock: the interval of the ratio */
    double build_ms;                      /* of its trees; < 0: not built anew */
    whit_difference error;                /* to the reference of the most samples */
    whit_difference alone;                /* to the reference of one sample; pixel_count 0: samples
                                             are what differs */
    uint64_t pixels_changed, ids_changed; /* from the usual picture, at the judged size */
    uint64_t non_finite;
    bool broken; /* SETTING_COST, and yet something changed */
    struct cost_hits hits[COST_SETS];
    bool best;           /* in the Pareto set: nothing measured is cheaper and as right */
    whit_image *picture; /* at the judged size, or NULL */
    whit_image *flip;    /* its FLIP map to the reference, or NULL */
};

/* What is asked for: cost_choose. */
enum cost_goal_kind { COST_UNDER, COST_WITHIN }; /* an error, a time in ms */
enum cost_metric { COST_RMSE, COST_FLIP };
const char *cost_metric_name(enum cost_metric metric); /* "rmse" */
enum { COST_GOALS_MAX = 5, COST_CHOICE_KNOBS = 32 };
struct cost_goal {
    enum cost_goal_kind kind;
    enum cost_metric metric;
    double limit;
    double of_usual; /* > 0: the limit is about this many times the time of the usual picture, and
                        nobody is told where it cannot be kept */
};
struct cost_answer {
    struct cost_goal goal;
    bool found, kept; /* kept: measured, it holds */
    uint32_t row;     /* that measured it; WHIT_NONE */
    double ms, error; /* predicted */
};

enum { COST_ROWS_MAX = 64, COST_ABSENT_MAX = 64, COST_KNOBS_ALL = 0 };
struct cost_absent {
    char name[64], why[64];
};

struct cost_report {
    uint32_t width, height, judged_width, judged_height;
    uint32_t reference_samples, reference_depth, reference_light_samples;
    double reference_ms[2]; /* of one sample, of the most: 0 where a cache had it */
    bool reference_cached[2];
    enum cost_clock clock;
    bool complete; /* else it was stopped: rows that are not measured are left out */
    double spent_ms;
    char device[256], driver[256];
    whit_device_kind kind;
    whit_load_path load_path;
    uint64_t scene_hash;
    uint32_t row_count; /* row 0: the usual settings */
    struct cost_row rows[COST_ROWS_MAX];
    uint32_t absent_count;
    struct cost_absent absent[COST_ABSENT_MAX];
    double usual_ms_max; /* 90 % of pictures took at most this, at full size, by the wall clock */
    double small_ms;     /* of the usual picture of cost_small_size, by the clock */
    uint32_t answer_count;
    struct cost_answer answers[COST_GOALS_MAX];
    whit_image *reference; /* of the most samples, or NULL */
};

struct cost_request {
    whit_device *device;
    const whit_scene *scene;
    whit_accel *accel;               /* with the usual settings; goes to the picture's time */
    const struct settings *settings; /* what knobs do not set is taken from it */
    const volatile bool *cancel;
    double time_limit_s;  /* of all measurements; 0: none */
    uint64_t knobs;       /* bits of knob_table; 0: all */
    double seconds;       /* that it may take, roughly */
    uint32_t samples_max; /* of the reference: 4, 16, 64; 0: 64, or 16 to be larger */
    /* The judged picture is no narrower and no lower, where the whole one is not. */
    uint32_t judged_width_min, judged_height_min;
    uint32_t rays; /* of each set; 0: none */
    uint32_t goal_count;
    struct cost_goal goals[COST_GOALS_MAX]; /* each gets a row that measures the choice */
    bool keep_pictures;
    void (*progress)(void *user, double done, double seconds_left, const char *what);
    void (*hush)(bool on); /* while a setting is tried that devices may refuse; or NULL */
    void *progress_user;
    const whit_log *log;
};

/* Stopped by `cancel`: WHIT_ERROR_CANCELLED, and *out has what is done. *out is NULL where
   there is nothing. */
WHIT_CHECK whit_result cost_measure(const struct cost_request *request, struct cost_report **out);
void cost_report_destroy(struct cost_report *report);
/* Frees what keep_pictures has kept; the figures stay. */
void cost_report_drop_pictures(struct cost_report *report);
/* The size of a small picture whose time tells how fast the device is at this moment. */
void cost_small_size(const struct cost_report *report, uint32_t *width, uint32_t *height);
/* The FNV-1a hash of a text, for names of cached files. */
uint64_t cost_hash(const char *text);

/* ---- Answers (choose.c) ---- */

/* A prediction may use up this share of the time or error asked for, since it was measured at
   another time; a picture that takes less than the second share of its predicted time leaves room
   for better settings. */
#define COST_ROOM       0.9
#define COST_TOO_LITTLE 0.6

double cost_error_of(const whit_difference *difference, enum cost_metric metric);

/* By the report's figures: ratios multiply, squared errors and FLIP add up. Numerics and instances
   stay as they are, for what they get wrong is not told by one picture; of knobs that change
   nothing the fastest setting is taken; as many samples as the reference has count with half the
   error of a quarter of them. The cheapest with an error of at most `limit`; or of those that 9 of
   10 times take at most `limit` ms by the wall clock the one that gives up least, in the order of
   within.c, with as many samples as fit, up to 64. */
struct cost_choice {
    uint8_t settings[COST_CHOICE_KNOBS]; /* of each knob of the table */
    uint32_t samples;                    /* of a pixel; 0: as the knob's setting says */
    double bailout;                      /* likewise */
    double ms, error;                    /* predicted: wall clock of the full picture; the metric */
    bool found;
};
struct cost_choice cost_choose(const struct cost_report *report, const struct cost_goal *goal);
/* The choice by RMSE within COST_ROOM of `budget_ms`; where no setting keeps that 9 of 10 times,
   one that keeps the budget in the median. */
struct cost_choice cost_choose_budget(const struct cost_report *report, double budget_ms);
void cost_choice_apply(const struct cost_choice *choice, struct settings *settings);
/* As options of `whit render`. */
void cost_choice_text(const struct cost_choice *choice, char *text, size_t text_bytes);

/* What a row is good for beside the usual settings. */
enum cost_use { COST_USE_TRADE, COST_USE_NONE, COST_USE_FREE };
/* NONE: neither cheaper nor more right; FREE: cheaper and as right (within 1 %). */
enum cost_use cost_use_of(const struct cost_report *report, const struct cost_row *row);

/* ---- What a report says first (findings.c) ---- */

/* Names the report's clock: "time" by the wall clock, "processor time", "device time". */
const char *cost_time_name(const struct cost_report *report);

/* A sentence without its full stop, and the figures of the report that it rounds. */
enum { COST_FINDINGS_MAX = 5, COST_FINDING_VALUES = 4 };
struct cost_finding {
    char text[192];
    uint32_t value_count;
    double values[COST_FINDING_VALUES];
};
/* Fills up to five findings, in this order: what more time buys, which bounces are seen, what exact
   hits cost, which setting is cheaper and as right, which effect takes most of the time. A finding
   whose rows were not measured is left out. Gives their number. */
uint32_t cost_findings(const struct cost_report *report,
                       struct cost_finding findings[COST_FINDINGS_MAX]);
/* The first ones as one sentence. */
enum { COST_SENTENCE_BYTES = 1024 };
void cost_sentence(const struct cost_report *report, char text[COST_SENTENCE_BYTES]);

/* ---- One crop at several times (strip.c) ---- */

/* A quarter of the usual time, once, four and sixteen times. */
enum { COST_STRIP = 4 };
struct cost_share {
    double of_usual;
    uint32_t row; /* the best picture within it; WHIT_NONE: nothing that was measured is as quick */
};
/* Adds what the strip shows to the goals of a request, and keeps its pictures. */
void cost_strip_ask(struct cost_request *request);
void cost_strip(const struct cost_report *report, struct cost_share strip[COST_STRIP]);
/* Whether the reference can judge the row: the samples of a picture that has as many are the same
   ones. */
bool cost_is_judged(const struct cost_report *report, const struct cost_row *row);
/* A fifth of the judged picture on each side, where the usual one is most visibly wrong. */
struct cost_crop {
    uint32_t x, y, width, height;
};
struct cost_crop cost_crop(const struct cost_report *report);

/* ---- What is kept from one run to the next ---- */

/* What figures are of: scene, size, device, and all settings that decide pixels or time but for
   what is chosen. */
struct cost_place {
    const struct settings *settings; /* with the time or the error that is asked for */
    whit_scene_info scene;
    whit_device_info device;
};

/* Figures, and what was chosen by them for settings->budget_ms of their place. */
struct cost_kept_figures {
    struct cost_report report; /* without its reference */
    struct cost_choice choice; /* not found: none was made as yet */
    double choice_ms;          /* that its picture was expected to take, or took */
    char made[32];             /* when it was measured, for people */
};

#endif

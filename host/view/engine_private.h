/* The engine from inside: its threads share this under one lock. */
#ifndef VIEW_ENGINE_PRIVATE_H
#define VIEW_ENGINE_PRIVATE_H

#include <pthread.h>

#include "base/threads.h"
#include "view/engine.h"

enum { ENGINE_SESSIONS_MAX = 8, ENGINE_LANES = 2 };

/* A session in the making. */
struct engine_job {
    struct session *session;
    struct settings settings;
    struct scene_ref *scene;
    struct shader_ref *shader;
    bool reloads;  /* the session has drawn before, with another version of the shader */
    bool is_spare; /* nobody waits for it */
    struct engine_frame preview; /* the first step by the new version; without pixels: none */
    struct session_progress progress;
    struct thread *thread;
    struct engine *engine;
    double start_ms;
    whit_result result;
    bool done; /* under the lock */
};

/* How good a picture is. Each is tried in turn, unless the next one takes no longer than allowed.
 */
enum engine_quality {
    ENGINE_QUICK, /* within the budget */
    ENGINE_FULL,  /* all pixels, one sample */
    ENGINE_WHOLE, /* all that the settings say */
};

/* What is asked for and what came of it; [0] is the window's, [1] the other side of a split. */
struct engine_lane {
    bool wanted;
    struct settings settings;
    bool moving;
    double asked_ms;             /* when `settings` came */
    uint64_t asked;              /* counts what is asked for */
    uint64_t drawn;              /* `asked` of the last picture */
    enum engine_quality quality; /* of it */
    bool failed;                 /* it could not be drawn; until asked again */
    struct settings last;        /* drawn */
    bool stale;                  /* drawn by an older session: a better one is in the making */
    struct session *session;     /* that drew last; NULL: none, or gone */
    struct engine_frame frame;   /* the newest picture; number 0: taken */
    uint64_t frames;
    uint64_t first;       /* of them, of what is asked for */
    uint64_t place;       /* engine.places, when it drew */
    uint32_t divisor;     /* of the last quick one; 0: none */
    uint32_t shown;       /* divisor of the last picture */
    double ms_per_sample; /* of pictures of its session; 0: not known */
};

/* A whole picture, for comparing. */
struct engine_kept {
    struct settings settings;
    whit_stats stats;
    whit_accel_info accel;
    uint32_t width, height;
    float *color;  /* RGBA; NULL where costs were painted */
    float *plain;  /* as engine_frame.plain, or NULL */
    float *cuts;   /* as engine_frame.cuts, or NULL */
    uint32_t *ids; /* instance, primitive; NULL: nothing is kept */
};

/* A picture on its way to more samples (engine_refine.c); of the drawing thread. */
struct engine_refine {
    struct engine_frame base; /* the whole picture of the settings, without what it owns */
    double begun_ms;          /* that the picture took that it began with */
    uint32_t samples;         /* of what was displayed last; 0: there is nothing to refine */
    bool settled;             /* more samples change nothing that is seen */
    bool ended;               /* there are no more, or they could not be drawn */
    whit_refine *refine;      /* NULL: not begun */
    uint8_t *rgba;            /* what was displayed last */
    struct engine_estimate estimates[ENGINE_ESTIMATES_MAX];
    uint32_t estimate_count;
};

/* FLIP of the first whole picture of a new version of the shader, in a thread of its own. */
struct engine_flip {
    struct engine *engine;
    struct thread *thread;
    uint64_t number;         /* of the reload */
    struct engine_kept kept; /* before it */
    whit_image *after;
    bool known, done; /* done: under the lock */
    double mean;
};

/* Two pictures that are drawn in turns, before and after something changed; of the drawing thread.
 */
struct engine_turns {
    struct settings settings[2];
    struct sample_runs ms[2]; /* of drawing */
    double start_ms;
    bool stopped; /* something else came first */
};
enum { ENGINE_PAIRS_MIN = 6 };

/* What is measured of a reload; of the drawing thread. */
struct engine_reloading {
    struct engine_kept before; /* the picture that FLIP is still missing of; without ids: none */
    struct engine_turns turns; /* of the version before and of the new one */
    bool wanted;               /* engine_measure_reload */
};

struct engine {
    struct engine_params params;
    struct engine_refine refine[ENGINE_LANES];
    bool refining; /* something of it is being drawn */
    struct engine_reload reload;
    struct engine_reloading reloading;
    struct engine_flip *flip;     /* NULL: not at work */
    struct engine_turns changing; /* for `change` */
    bool change_left; /* something else was asked for, or its time is measured elsewhere */
    const struct engine_turns *timing; /* a picture of which is being drawn; NULL: of none */
    pthread_mutex_t lock;
    pthread_cond_t work, news;
    struct thread *thread;
    bool quit;
    struct engine_lane lanes[ENGINE_LANES];
    struct settings place; /* of the window's last picture: that of the other one */
    uint32_t place_divisor;
    uint64_t places;                               /* how often that was set */
    struct engine_job *job;                        /* NULL: none */
    uint64_t jobs;                                 /* that were started */
    struct session *sessions[ENGINE_SESSIONS_MAX]; /* of the drawing thread; NULL: free */
    struct session *drawing; /* whose cancel flag stops what is being drawn; NULL: nothing is */
    double drawing_since_ms; /* when it began */
    bool brief; /* it is done soon: who moves on waits for it, or sees nothing at all */
    struct shader_ref *versions[2]; /* of the shader in the window's pictures: the last, and the one
                                       before; NULL: none */
    uint64_t shown;  /* number of the window's picture on the screen: engine_note_shown */
    uint64_t yields; /* number of one that the screen is waited for, as drawing on two cores holds
                        it up; until yields_ms */
    double yields_ms;
    double spare_ms; /* by whit_clock_ms: when a session for the next version of the shader is to be
                        made; 0: there is none to make */
    uint32_t validation; /* messages, of sessions that are gone */
    bool busy;           /* something is being drawn, or memory given back */
    bool littered;       /* a session was made or dropped: its memory lies about in the heaps */
    uint64_t uses;
    uint32_t lost; /* devices lost one after the other */
    char error[ENGINE_MESSAGE];
    char errors[SESSION_ERRORS];
    char refused[SETTING_PATH_BYTES]; /* as session.refused, of the last job that loaded a scene */
    whit_result result;               /* that failed last */
    bool device_lost;
    struct engine_change change;
    bool probe_wanted;
    uint32_t probe_x, probe_y;
    uint64_t probes;
    struct engine_probe probe; /* the newest; number 0: taken */
    struct engine_kept last;   /* of the drawing thread: the window's last whole picture */
    struct engine_kept other;  /* likewise: that of the other side of a split */
    struct engine_kept single[ENGINE_LANES]; /* of a lane: one sample of the picture that its refine
                                                goes on with; without ids: none */
};

/* What engine_draw is to draw. */
struct engine_task {
    struct session *session;
    struct settings settings;
    enum engine_quality quality;
    uint32_t divisor;
    uint32_t step_spacing; /* of the first step; 0: at once */
    bool moving, brief;    /* brief: the first picture of what is asked for */
    bool finishes;         /* it, or its first step, is within the budget, and is not cancelled */
    struct engine_refine *refine; /* has some of its samples, and draws the others; NULL: none */
    const struct engine_kept *single; /* that it began with */
    double asked_ms;
    struct engine *engine; /* that shows the steps, in `lane` */
    struct engine_lane *lane;
    uint64_t asked; /* of the lane */
};

/* engine.c, with the lock. */
void engine_wake(struct engine *engine);
bool engine_is_done(const struct engine_lane *lane);

/* Shows the first step of a picture that a job has drawn, where that is what is asked for. */
void engine_show_preview(struct engine *engine, struct engine_job *job);

/* engine_sessions.c, of the drawing thread, with the lock but for drop and destroy. */
/* Whether both differ in the version of their shader alone, or in nothing that kernels know. */
bool engine_same_but_version(const struct settings *a, const struct settings *b);
/* Starts a session for the next version of the window's shader, once its picture has been there for
   a while, so that the first save does not wait for one. */
void engine_make_spare(struct engine *engine);
WHIT_CHECK bool engine_start_job(struct engine *engine, const struct settings *settings);
/* Takes what a finished job made. */
void engine_reap_job(struct engine *engine);
void engine_job_destroy(struct engine_job *job);
struct session *engine_find_session(const struct engine *engine, const struct settings *settings);
void engine_drop_session(struct engine *engine, struct session *session);
/* The device is gone: everything on it is made again, unless that happens again and again. */
void engine_lose_device(struct engine *engine, struct session *session);
/* Clears the error of the window, unless the other side of a comparison has failed as well. */
void engine_forget_error(struct engine *engine);

/* engine_draw.c: how good the next picture of a lane is to be, and how large. */
void engine_plan(const struct engine *engine, const struct engine_lane *lane,
                 struct engine_task *task);
/* Draws; of the drawing thread, without the lock. *frame is the caller's to finish. */
WHIT_CHECK whit_result engine_draw(const struct engine_task *task, struct engine_frame *frame);
/* A step on the way to it. WHIT_ERROR_MEMORY: there is nothing to show. */
WHIT_CHECK whit_result engine_draw_step(const struct engine_task *task, const whit_step *step,
                                        struct engine_frame *frame);
/* engine.c: shows a step of the picture that is being drawn. */
void engine_show_step(void *user, const whit_step *step);
/* Shows *frame, which it takes, of fewer samples than the picture of the task will have. */
void engine_show_samples(const struct engine_task *task, struct engine_frame *frame);
/* engine_refine.c: whether pictures of these settings can be refined. */
bool engine_refines(const struct settings *settings);
/* Whether the samples that the settings say come by doubling those that there are. */
bool engine_doubles(const struct settings *settings);
/* With the lock: lets a whole picture of all samples go on from the one that is shown, where its
   refine has that. */
void engine_refine_join(struct engine *engine, struct engine_task *task);
/* Draws the samples of the task that its refine lacks, in place of all, and shows steps on the way.
   Without the lock. *frame then has colours, ids, cuts and statistics. */
WHIT_CHECK whit_result engine_refine_whole(const struct engine_task *task,
                                           struct engine_frame *frame);
/* With the lock: the task's refine made *frame, and goes on beyond it. */
void engine_refine_finish_whole(struct engine_refine *refine, const struct engine_frame *frame);
/* Begins with a whole picture of the window; one that cannot be refined, by costs
   or adaptive samples, ends it. */
void engine_refine_begin(struct engine_refine *refine, const struct engine_frame *frame);
void engine_refine_stop(struct engine_refine *refine);
/* Goes on from where it was, as a whole picture of the window came to the same pixels as the one
   that it began with: *frame then shows as many samples as the picture before. False: it cannot. */
WHIT_CHECK bool engine_refine_keep(struct engine_refine *refine, const struct engine_kept *kept,
                                   struct session *session, struct engine_frame *frame);
/* With the lock: the lane whose picture is to be refined next; NULL: none, or something else is to
   be done. Of A beside B the one of fewer samples, until both look the same as before. */
struct engine_lane *engine_refine_lane(struct engine *engine);
/* Draws some of it. With the lock, which it gives back meanwhile. */
void engine_refine_one(struct engine *engine, struct engine_lane *lane);
/* With the lock: a side whose picture has more samples than its settings say is drawn again, as the
   other one begins anew. */
void engine_refine_restart(struct engine *engine, struct engine_lane *lane);
/* With the lock. What is asked for comes first; what was being drawn is drawn again later. */
void engine_refine_pause(struct engine *engine);

/* The picture of a task once more, for its times alone. Of the drawing thread, without the lock. */
WHIT_CHECK whit_result engine_draw_again(const struct engine_task *task, whit_stats *stats);

/* engine_reload.c, of the drawing thread, with the lock. There is a whole picture of settings
   `after`, and before it there was *before, which it may take; `difference`: between them, NULL
   where they are not of one place. */
void engine_reload_note(struct engine *engine, struct engine_kept *before,
                        const struct settings *after, const struct difference *difference);
/* Measures, where there is something to measure and nothing else to do; gives the lock back
   meanwhile. False: there was not. */
bool engine_reload_step(struct engine *engine);
void engine_reload_stop(struct engine *engine); /* with the lock: engine_stop_reload */
void engine_flip_destroy(struct engine_flip *flip);

/* engine_turns.c, with the lock. */
/* Whether pictures are there as they were asked for, and nothing else is to be done. */
bool engine_is_idle(const struct engine *engine);
/* Fills in turns->ms, and *difference by how much the second picture takes longer in ms. Gives the
   lock back meanwhile. "" or why there were too few pairs; *difference is then untouched. */
const char *engine_turns_measure(struct engine *engine, struct engine_turns *turns,
                                 struct sample_median *difference);
extern const char ENGINE_TURNS_STOPPED[]; /* one of these reasons */

/* engine_change.c, with the lock: measures the last change, which takes a while, unless something
   else comes first. `late`: there is nothing left to refine. False: there was nothing to do. */
bool engine_change_step(struct engine *engine, bool late);
void engine_change_stop(struct engine *engine);
bool engine_change_waits(const struct engine *engine); /* whether it is to be measured as yet */
/* What differs between two whole pictures of one place; *change stays where they
   are none, or differ in nothing that has a name. */
void engine_compare(const struct engine_kept *before, const struct engine_frame *after,
                    struct engine_change *change);
/* Whether both are of one place, with the same ids and colours. */
bool engine_is_same(const struct engine_kept *before, const struct engine_frame *after);
/* In place of what was kept. Keeps nothing where memory runs out. */
void engine_keep(struct engine_kept *kept, const struct engine_frame *frame);
void engine_kept_finish(struct engine_kept *kept);

#endif

/* The inside of the engine: what its threads share under one lock. */
#ifndef VIEW_ENGINE_PRIVATE_H
#define VIEW_ENGINE_PRIVATE_H

#include <pthread.h>

#include "base/threads.h"
#include "view/engine_change.h"
#include "view/engine_refine.h"
#include "view/engine_reload.h"
#include "view/engine_turns.h"
#include "view/pace.h"

struct engine_job;
struct engine_task;

enum { ENGINE_SESSIONS_MAX = 4, ENGINE_LANES = 2 };

/* Qualities of a picture. They are drawn one after the other; a quality is skipped if the next one
   is quick enough. */
enum engine_quality {
    ENGINE_QUICK, /* smaller, within the budget */
    ENGINE_FULL,  /* all pixels, one sample */
    ENGINE_WHOLE, /* all samples of the settings */
};

/* A side of the window: what is asked for it, and its last picture. lanes[0] is the window's
   picture (A), lanes[1] side B of a comparison. */
struct engine_lane {
    bool wanted;
    struct settings settings;
    bool moving;
    double asked_ms;             /* by whit_clock_ms: when `settings` were asked for */
    uint64_t asked;              /* number of requests so far */
    uint64_t drawn;              /* `asked` of the last picture */
    enum engine_quality quality; /* quality of the last picture */
    bool failed;                 /* the request could not be drawn */
    struct settings last;        /* settings of the last picture */
    bool timed;                  /* the stages of the last picture were timed */
    /* The last picture is by an older session, while the right one is being made; or its renderer
       could not be set back to its view. */
    bool stale;
    bool previewed;          /* the last picture is the first step of a new version of the shader */
    struct session *session; /* session of the last picture; NULL: none, or gone */
    struct engine_frame frame; /* the newest picture; number 0: taken */
    uint64_t frames;
    uint64_t first;   /* number of the first picture of the request */
    uint64_t place;   /* engine.places when the last picture was drawn */
    uint32_t shown;   /* divisor of the last picture */
    struct pace pace; /* of its session */
    /* For the drawing thread: */
    struct engine_refine refine;
    struct engine_frame whole;  /* the last whole picture */
    struct engine_frame single; /* the picture of one sample that `refine` goes on with; without
                                  ids: none */
};

struct engine {
    struct engine_params params;
    bool refining;               /* samples are being added to a picture now */
    struct engine_status status; /* but for what engine_get_status adds */
    struct engine_reloading reloading;
    struct engine_flip *flip;     /* NULL: no thread is running */
    struct engine_turns changing; /* measures `change` */
    /* `change` is not measured: something else was asked for, or `reload` measures the same. */
    bool change_left;
    const struct engine_turns *timing; /* the pairs that are drawn now; NULL: none */
    pthread_mutex_t lock;
    pthread_cond_t work, news;
    struct thread *thread;
    bool quit;
    struct engine_lane lanes[ENGINE_LANES];
    struct settings place; /* settings of A's last picture; B has its camera, time and size */
    uint32_t place_divisor;
    uint64_t places;                               /* how often `place` was set */
    struct engine_job *job;                        /* NULL: none */
    uint64_t jobs;                                 /* number of jobs so far */
    struct session *sessions[ENGINE_SESSIONS_MAX]; /* used by the drawing thread; NULL: free */
    struct session *drawing; /* the session that draws: its `cancel` stops it; NULL: none */
    double drawing_since_ms; /* when `drawing` began to draw */
    /* The current picture is done soon and is not cancelled: otherwise nothing at all would be
       shown while the camera moves on. */
    bool brief;
    /* Versions of the shader in the window's pictures: the last, and the one before; NULL: none. */
    struct shader_ref *versions[2];
    uint64_t shown; /* number of the window's picture on the screen: engine_note_shown */
    /* Number of a picture that has to be on screen before drawing goes on, as drawing on two cores
       would hold it up; at most until yields_ms. */
    uint64_t yields;
    double yields_ms;
    /* By whit_clock_ms: when a spare session for the next version of the shader is to be made; 0:
       none is. */
    double spare_ms;
    uint32_t validation; /* messages about sessions that are gone */
    bool busy;           /* the drawing thread draws, or gives memory back */
    bool littered;       /* a session was made or dropped: the heaps have free memory */
    uint64_t uses;
    struct file_list unread; /* files of the last scene that could not be shown */
    uint32_t lost;           /* devices lost without a picture in between */
    bool probe_wanted;
    uint32_t probe_x, probe_y;
    uint64_t probes;
    struct engine_probe probe; /* the newest probe; number 0: it was taken */
};

/* Called with engine->lock held. */
void engine_wake(struct engine *engine);
bool engine_is_done(const struct engine_lane *lane);

/* Shows the first step of a picture that a job has drawn, if that picture is still asked for. */
void engine_show_preview(struct engine *engine, struct engine_job *job);

/* Shows a step of the picture that is being drawn. */
void engine_show_step(void *user, const whit_step *step);
/* Shows *frame, which has fewer samples than the task's picture will have, and owns it from then
   on. */
void engine_show_samples(const struct engine_task *task, struct engine_frame *frame);

#endif

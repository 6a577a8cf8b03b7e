/* The engine from inside: its threads share this under one lock. */
#ifndef VIEW_ENGINE_PRIVATE_H
#define VIEW_ENGINE_PRIVATE_H

#include <pthread.h>

#include "base/threads.h"
#include "view/engine_change.h"
#include "view/engine_refine.h"
#include "view/engine_reload.h"
#include "view/engine_turns.h"

struct engine_job;
struct engine_task;

enum { ENGINE_SESSIONS_MAX = 8, ENGINE_LANES = 2 };

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

/* With the lock. */
void engine_wake(struct engine *engine);
bool engine_is_done(const struct engine_lane *lane);

/* Shows the first step of a picture that a job has drawn, where that is what is asked for. */
void engine_show_preview(struct engine *engine, struct engine_job *job);

/* Shows a step of the picture that is being drawn. */
void engine_show_step(void *user, const whit_step *step);
/* Shows *frame, which it takes, of fewer samples than the picture of the task will have. */
void engine_show_samples(const struct engine_task *task, struct engine_frame *frame);

#endif

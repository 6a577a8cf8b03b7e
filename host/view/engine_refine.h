/* Adds samples to pictures at rest. */
#ifndef VIEW_ENGINE_REFINE_H
#define VIEW_ENGINE_REFINE_H

#include "view/engine.h"

struct engine_lane;
struct engine_task;

/* A picture to which samples are added; used by the drawing thread. */
struct engine_refine {
    struct engine_frame base; /* copy of the frame that refining began with; owns nothing */
    whit_stats begun;         /* of that frame */
    uint32_t samples;    /* samples a pixel of the picture displayed last; 0: nothing to refine */
    bool settled;        /* more samples change nothing visible */
    bool ended;          /* there are no more samples, or drawing them failed */
    whit_refine *refine; /* NULL: not begun */
    uint8_t *rgba;       /* the picture displayed last */
    struct engine_estimate estimates[ENGINE_ESTIMATES_MAX];
    uint32_t estimate_count;
};

/* Whether pictures of these settings can be refined. */
bool engine_refines(const struct settings *settings);
/* Whether the samples of the settings can be reached by doubling: their number is a power of 2. */
bool engine_doubles(const struct settings *settings);
/* Lets the task's picture of all samples continue the picture of one sample that is shown, if its
   refine has that. Called with engine->lock held. */
void engine_refine_join(struct engine_task *task);
/* Draws only the samples of the task that its refine does not have, and shows steps on the way.
   Called without engine->lock. *frame then has colours, ids and statistics. */
WHIT_CHECK whit_result engine_refine_whole(const struct engine_task *task,
                                           struct engine_frame *frame);
/* Lets samples be added to the picture of the task from now on. `same`: it has the same pixels as
   the picture before, and may then keep the samples that were added to that. Called with
   engine->lock held, which it may release meanwhile. */
void engine_refine_take(struct engine *engine, const struct engine_task *task, bool same,
                        struct engine_frame *frame);
void engine_refine_stop(struct engine_refine *refine);
/* The lane whose picture is to be refined next; NULL: none, or something else has to be done. If A
   and B are compared, it is the one with fewer samples, until neither changes visibly. Called with
   engine->lock held. */
struct engine_lane *engine_refine_lane(struct engine *engine);
/* Draws the next part of a lane's samples. Called with engine->lock held, which is released while
   it draws. */
void engine_refine_one(struct engine *engine, struct engine_lane *lane);
/* Lets a picture with more samples than its settings say be drawn again, as the other side begins
   anew. Called with engine->lock held. */
void engine_refine_restart(struct engine_lane *lane);
/* Stops refining for a request; the part that was being drawn is drawn again later. Called with
   engine->lock held. */
void engine_refine_pause(struct engine *engine);

#endif

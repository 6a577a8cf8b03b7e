/* The window's picture at rest gets better by itself. */
#ifndef VIEW_ENGINE_REFINE_H
#define VIEW_ENGINE_REFINE_H

#include "view/engine.h"

struct engine_kept;
struct engine_lane;
struct engine_task;

/* A picture on its way to more samples; of the drawing thread. */
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

/* Whether pictures of these settings can be refined. */
bool engine_refines(const struct settings *settings);
/* Whether the samples that the settings say come by doubling those that there are. */
bool engine_doubles(const struct settings *settings);
/* With the lock: lets a whole picture of all samples go on from the one that is shown, where its
   refine has that. */
void engine_refine_join(struct engine *engine, struct engine_task *task);
/* Draws the samples of the task that its refine lacks, in place of all, and shows steps on the way.
   Without the lock. *frame then has colours, ids and statistics. */
WHIT_CHECK whit_result engine_refine_whole(const struct engine_task *task,
                                           struct engine_frame *frame);
/* With the lock: lets samples be added to the picture of the task, which may then show as many as
   the one before. `same`: it has the same pixels as that. */
void engine_refine_take(struct engine *engine, const struct engine_task *task, bool same,
                        struct engine_frame *frame);
void engine_refine_stop(struct engine_refine *refine);
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

#endif

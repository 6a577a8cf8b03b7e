/* One picture of one session. */
#ifndef VIEW_ENGINE_DRAW_H
#define VIEW_ENGINE_DRAW_H

#include "view/engine_private.h"

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

/* How good the next picture of a lane is to be, and how large. */
void engine_plan(const struct engine *engine, const struct engine_lane *lane,
                 struct engine_task *task);
/* Draws; of the drawing thread, without the lock. *frame is the caller's to finish. */
WHIT_CHECK whit_result engine_draw(const struct engine_task *task, struct engine_frame *frame);
/* A step on the way to it. WHIT_ERROR_MEMORY: there is nothing to show. */
WHIT_CHECK whit_result engine_draw_step(const struct engine_task *task, const whit_step *step,
                                        struct engine_frame *frame);
/* The picture of a task once more, for its times alone. Of the drawing thread, without the lock. */
WHIT_CHECK whit_result engine_draw_again(const struct engine_task *task, whit_stats *stats);

#endif

/* Draws one picture with one session. */
#ifndef VIEW_ENGINE_DRAW_H
#define VIEW_ENGINE_DRAW_H

#include "view/engine_private.h"

/* A picture that engine_draw is to draw. */
struct engine_task {
    struct session *session;
    struct settings settings;
    enum engine_quality quality;
    uint32_t divisor;
    uint32_t step_spacing; /* spacing of the first step; 0: no steps */
    bool moving, brief;    /* brief: the first picture of a request */
    bool finishes; /* the picture, or its first step, fits the budget: it is not cancelled */
    struct engine_refine *refine; /* has some of its samples, and adds the others; NULL: none */
    const struct engine_frame *single; /* the picture of one sample that `refine` began with */
    double asked_ms;
    struct engine *engine; /* the engine that shows the steps, in `lane` */
    struct engine_lane *lane;
    uint64_t asked; /* lane->asked when the task began */
};

/* Plans quality and size of the next picture of a lane. */
void engine_plan(const struct engine *engine, struct engine_lane *lane, struct engine_task *task);
/* Notes how long a picture took, to plan the next ones by it. Called with engine->lock held. */
void engine_note_time(struct engine_lane *lane, const struct engine_frame *frame);
/* Draws a picture. Called on the drawing thread, without engine->lock. The caller calls
   engine_frame_finish. */
WHIT_CHECK whit_result engine_draw(const struct engine_task *task, struct engine_frame *frame);
/* Makes a frame of a step of the picture. WHIT_ERROR_MEMORY: there is nothing to show. */
WHIT_CHECK whit_result engine_draw_step(const struct engine_task *task, const whit_step *step,
                                        struct engine_frame *frame);
/* Draws the picture of a task again, to measure its time. Called on the drawing thread, without
   engine->lock. */
WHIT_CHECK whit_result engine_draw_again(const struct engine_task *task, whit_stats *stats);

#endif

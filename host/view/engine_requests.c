/* The requests of the window's thread to the engine, and the pictures and states that it takes. */
#include <stdio.h>
#include <string.h>

#include "view/engine_private.h"
#include "view/engine_sessions.h"
#include "whit/whit_program.h"

void engine_set_budget(struct engine *engine, double budget_ms)
{
    pthread_mutex_lock(&engine->lock);
    engine->params.budget_ms = budget_ms;
    pthread_mutex_unlock(&engine->lock);
}

/* Cancels the session being made if nobody wants it any more. */
static void stop_unwanted(struct engine *engine)
{
    const struct engine_job *job = engine->job;
    bool wanted = false;
    for (int i = 0; job && i < ENGINE_LANES; ++i) {
        const struct engine_lane *lane = &engine->lanes[i];
        wanted |= lane->wanted &&
                  (job->is_spare ? engine_same_but_version(&lane->settings, &job->settings)
                                 : settings_same_kernel(&lane->settings, &job->settings));
    }
    if (job && !wanted)
        job->session->cancel = true;
}

static void stop_background(struct engine *engine)
{
    engine_refine_pause(engine);
    engine_reload_stop(engine);
    engine_change_stop(engine);
}

static void ask_anew(struct engine *engine, struct engine_lane *lane)
{
    ++lane->asked;
    lane->asked_ms = whit_clock_ms();
    lane->failed = false;
    if (engine->drawing && !engine->brief)
        engine->drawing->cancel = true;
}

static void ask(struct engine *engine, struct engine_lane *lane, const struct settings *settings,
                bool moving)
{
    bool same = lane->wanted && settings_same(&lane->settings, settings);
    if (same && lane->moving == moving)
        return;
    stop_background(engine);
    if (!same) {
        engine->change_left = true;
        ask_anew(engine, lane);
    }
    lane->wanted = true;
    lane->settings = *settings;
    lane->moving = moving;
    stop_unwanted(engine);
    pthread_cond_signal(&engine->work);
}

void engine_time_stages(struct engine *engine, bool on)
{
    pthread_mutex_lock(&engine->lock);
    struct engine_lane *lane = &engine->lanes[0];
    bool began = on && !engine->params.time_stages;
    engine->params.time_stages = on;
    if (began && lane->wanted) {
        stop_background(engine);
        ask_anew(engine, lane);
        pthread_cond_signal(&engine->work);
    }
    pthread_mutex_unlock(&engine->lock);
}

void engine_ask(struct engine *engine, const struct settings *settings, bool moving)
{
    pthread_mutex_lock(&engine->lock);
    struct engine_lane *other = &engine->lanes[1];
    bool anew = !settings_same(&engine->lanes[0].settings, settings);
    ask(engine, &engine->lanes[0], settings, moving);
    if (other->wanted && anew)
        engine_refine_restart(other);
    if (other->wanted) {
        struct settings there = other->settings;
        settings_set_camera(&there, settings);
        ask(engine, other, &there, moving);
    }
    pthread_mutex_unlock(&engine->lock);
}

void engine_ask_other(struct engine *engine, const struct settings *settings)
{
    pthread_mutex_lock(&engine->lock);
    struct engine_lane *other = &engine->lanes[1];
    if (settings) {
        /* Pictures side by side have the same number of samples. */
        if (!other->wanted)
            engine_refine_restart(&engine->lanes[0]);
        ask(engine, other, settings, engine->lanes[0].moving);
    } else {
        other->wanted = false;
        stop_unwanted(engine);
        engine_frame_finish(&other->frame);
    }
    pthread_mutex_unlock(&engine->lock);
}

void engine_watch_unread(struct engine *engine, struct watch *watch)
{
    pthread_mutex_lock(&engine->lock);
    for (uint32_t i = 0; i < engine->unread.count; ++i)
        watch_add(watch, engine->unread.paths[i], engine->unread.since_ns);
    pthread_mutex_unlock(&engine->lock);
}

void engine_get_status(struct engine *engine, struct engine_status *status)
{
    pthread_mutex_lock(&engine->lock);
    const struct engine_job *job = engine->job;
    *status = engine->status;
    status->stage = job && !job->is_spare ? (enum session_stage)atomic_load(&job->session->stage)
                                          : SESSION_DONE;
    status->stage_ms = job ? whit_clock_ms() - job->start_ms : 0.0;
    status->makes_spare = job && job->is_spare;
    status->drawing = !engine_is_done(&engine->lanes[0]) || !engine_is_done(&engine->lanes[1]);
    status->failed = engine->lanes[0].failed;
    if (engine->drawing && !engine->refining &&
        !engine->timing) { /* nobody waits for refining and timing */
        status->drawing_ms = whit_clock_ms() - engine->drawing_since_ms;
        status->part = atomic_load(&engine->drawing->part);
    }
    pthread_mutex_unlock(&engine->lock);
}

bool engine_take(struct engine *engine, bool other, struct engine_frame *frame)
{
    pthread_mutex_lock(&engine->lock);
    struct engine_lane *lane = &engine->lanes[other ? 1 : 0];
    bool newer = lane->frame.number > frame->number;
    if (newer) {
        engine_frame_finish(frame);
        *frame = lane->frame;
        lane->frame = (struct engine_frame){0};
        pthread_cond_signal(&engine->work); /* the picture may be refined now */
    }
    pthread_mutex_unlock(&engine->lock);
    return newer;
}

void engine_note_shown(struct engine *engine, uint64_t number)
{
    pthread_mutex_lock(&engine->lock);
    engine->shown = number;
    if (engine->yields == number)
        pthread_cond_signal(&engine->work);
    pthread_mutex_unlock(&engine->lock);
}

void engine_ask_probe(struct engine *engine, uint32_t x, uint32_t y)
{
    pthread_mutex_lock(&engine->lock);
    engine->probe_wanted = true;
    engine->probe_x = x;
    engine->probe_y = y;
    stop_background(engine);
    pthread_cond_signal(&engine->work);
    pthread_mutex_unlock(&engine->lock);
}

bool engine_take_probe(struct engine *engine, struct engine_probe *probe)
{
    pthread_mutex_lock(&engine->lock);
    bool newer = engine->probe.number > probe->number;
    if (newer) {
        engine_probe_finish(probe);
        *probe = engine->probe;
        engine->probe = (struct engine_probe){0};
    }
    pthread_mutex_unlock(&engine->lock);
    return newer;
}

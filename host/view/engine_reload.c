/* Compares pictures of a new version of the shader and the version before. Both keep their
   sessions, so that the effect of a save can be measured while there is nothing else to do. */
#include <stdlib.h>
#include <string.h>

#include "view/difference.h"
#include "view/engine_private.h"
#include "view/engine_reload.h"

/* ---- How different they look ---- */

static void run_flip(void *context)
{
    struct engine_flip *flip = context;
    struct engine *engine = flip->engine;
    flip->known = difference_flip(flip->before, flip->after, &flip->mean, NULL);
    pthread_mutex_lock(&engine->lock);
    flip->done = true;
    pthread_cond_signal(&engine->work);
    pthread_mutex_unlock(&engine->lock);
}

void engine_flip_destroy(struct engine_flip *flip)
{
    if (!flip)
        return;
    thread_join(flip->thread);
    whit_image_destroy(flip->before);
    whit_image_destroy(flip->after);
    free(flip);
}

/* Starts a thread that compares the pictures before and after a reload by FLIP, while drawing goes
   on. Call it with engine->lock held. */
static void start_flip(struct engine *engine)
{
    struct engine_flip *flip = calloc(1, sizeof *flip);
    if (flip) {
        *flip = (struct engine_flip){.engine = engine,
                                     .number = engine->status.reload.number,
                                     .before = whit_image_share(engine->reloading.before.color),
                                     .after = whit_image_share(engine->lanes[0].whole.color)};
        flip->thread = flip->after ? thread_start(run_flip, flip) : NULL;
    }
    engine_frame_finish(&engine->reloading.before);
    if (flip && flip->thread)
        engine->flip = flip;
    else
        engine_flip_destroy(flip);
}

static void reap_flip(struct engine *engine)
{
    struct engine_flip *flip = engine->flip;
    if (!flip || !flip->done)
        return;
    if (flip->number == engine->status.reload.number) {
        engine->status.reload.has_flip = flip->known;
        engine->status.reload.flip = flip->mean;
    }
    engine->flip = NULL;
    engine_flip_destroy(flip);
    engine_wake(engine);
}

/* ---- How long they take ---- */

static void end_reload(struct engine *engine, const char *why)
{
    engine->status.reload.over = true;
    engine->status.reload.why = why;
    engine_frame_finish(&engine->reloading.before);
    engine_wake(engine);
}

/* ---- When ---- */

bool engine_reload_step(struct engine *engine)
{
    struct engine_reloading *reloading = &engine->reloading;
    reap_flip(engine);
    if (!reloading->wanted || engine->status.reload.over || !engine_is_idle(engine))
        return false;
    if (engine->flip)
        return false; /* the FLIP thread wakes this one when it is done */
    if (reloading->before.color) {
        start_flip(engine);
        return true;
    }
    end_reload(engine, engine_turns_measure(engine, &reloading->turns, &engine->status.reload.ms));
    return true;
}

void engine_reload_note(struct engine *engine, struct engine_frame *before,
                        const struct settings *after, const struct difference *difference)
{
    struct engine_reloading *reloading = &engine->reloading;
    struct engine_reload *reload = &engine->status.reload;
    struct settings same = *after;
    if (!before->ids && after->shader_reload > 0)
        *reload = (struct engine_reload){.number = reload->number + 1,
                                         .settings = *after,
                                         .over = true,
                                         .why = "no whole picture was shown before it"};
    same.shader_reload = before->settings.shader_reload;
    if (!before->ids || after->shader_reload <= before->settings.shader_reload ||
        !settings_same_shader(&same, &before->settings))
        return;
    engine_frame_finish(&reloading->before);
    reloading->turns.settings[0] = same;
    reloading->turns.settings[1] = *after;
    reloading->wanted = reloading->turns.stopped = false;
    *reload = (struct engine_reload){.number = reload->number + 1, .settings = *after, .why = ""};
    if (!difference || !settings_same(&same, &before->settings))
        return;
    reload->compared = true;
    reload->has_colors = before->color && after->paint == PAINT_COLOR;
    reload->difference = *difference;
    reloading->before = *before;
    *before = (struct engine_frame){.settings = before->settings};
}

void engine_reload_stop(struct engine *engine)
{
    if (engine->status.reload.number == 0 || engine->status.reload.over)
        return;
    engine->reloading.turns.stopped = engine->status.reload.stopped = true;
    if (engine->timing == &engine->reloading.turns)
        engine->drawing->cancel = true;
    else
        end_reload(engine, ENGINE_TURNS_STOPPED);
}

void engine_measure_reload(struct engine *engine)
{
    pthread_mutex_lock(&engine->lock);
    engine->reloading.wanted = engine->status.reload.number > 0;
    pthread_cond_signal(&engine->work);
    pthread_mutex_unlock(&engine->lock);
}

void engine_stop_reload(struct engine *engine)
{
    pthread_mutex_lock(&engine->lock);
    engine_reload_stop(engine);
    pthread_mutex_unlock(&engine->lock);
}

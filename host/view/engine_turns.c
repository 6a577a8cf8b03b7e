#include "view/engine_turns.h"
#include "view/engine_draw.h"
#include "view/engine_private.h"
#include "view/engine_sessions.h"

/* 9 pairs are drawn at most: their confidence interval goes from the second to the eighth
   difference. 6 pairs are the fewest that give an interval of 95 % (base/sample.h). */
enum { PAIRS = 9 };
/* Times after which measuring stops: with 6 pairs, and with any number of pairs. */
static const double ENOUGH_MS = 5e3, PATIENCE_MS = 20e3;
const char ENGINE_TURNS_STOPPED[] = "something else came first";

bool engine_is_idle(const struct engine *engine)
{
    for (int i = 0; i < ENGINE_LANES; ++i) {
        const struct engine_lane *lane = &engine->lanes[i];
        if (!engine_is_done(lane) || (lane->wanted && (lane->moving || lane->failed)) ||
            lane->frame.number > 0)
            return false;
    }
    return !engine->quit && !engine->job && !engine->probe_wanted;
}

/* Draws one picture of one side; called with engine->lock held, which is released meanwhile. */
static whit_result draw_turn(void *user, uint32_t way, uint32_t round)
{
    struct engine_turns *turns = user;
    struct engine *engine = turns->engine;
    struct engine_task task = {.settings = turns->settings[way],
                               .quality = ENGINE_WHOLE,
                               .divisor = 1,
                               .session = engine_find_session(engine, &turns->settings[way])};
    whit_stats stats;
    double spent_ms = whit_clock_ms() - turns->start_ms;
    if (!task.session || !engine_is_idle(engine) || turns->stopped)
        return WHIT_ERROR_CANCELLED;
    if (spent_ms > PATIENCE_MS || (round >= ENGINE_PAIRS_MIN && spent_ms > ENOUGH_MS))
        return WHIT_ERROR_CANCELLED;
    task.session->cancel = false;
    engine->drawing = task.session;
    engine->timing = turns;
    engine->brief = false;
    pthread_mutex_unlock(&engine->lock);
    whit_result result = engine_draw_again(&task, &stats);
    pthread_mutex_lock(&engine->lock);
    engine->drawing = NULL;
    engine->timing = NULL;
    if (result == WHIT_OK)
        sample_add(&turns->ms[way], engine_drawn_ms(&stats));
    else if (result == WHIT_ERROR_DEVICE)
        engine_lose_device(engine, task.session);
    return result;
}

/* Sets the renderers of the shown pictures back to their views, as clicked pixels are traced by
   them. Called with engine->lock held, which is released meanwhile: errors are logged under it. */
static void show_again(struct engine *engine, const struct engine_turns *turns)
{
    for (int i = 0; i < ENGINE_LANES; ++i) {
        struct engine_lane *lane = &engine->lanes[i];
        struct session *session = lane->session;
        if (!session || (i > 0 && (!lane->wanted || session == engine->lanes[0].session)))
            continue;
        session->settings = lane->last;
        const whit_renderer_params params = session_picture(session);
        engine->drawing = session;
        engine->timing = turns;
        pthread_mutex_unlock(&engine->lock);
        whit_result result = whit_renderer_set_view(session->renderer, &params);
        pthread_mutex_lock(&engine->lock);
        engine->drawing = NULL;
        engine->timing = NULL;
        if (result != WHIT_OK)
            lane->stale = true; /* draw it again, which reports the error */
    }
}

/* Tells why fewer than ENGINE_PAIRS_MIN pairs were drawn. */
static const char *why_not(const struct engine *engine, const struct engine_turns *turns,
                           whit_result result)
{
    for (int i = 0; i < 2; ++i) {
        if (!engine_find_session(engine, &turns->settings[i]))
            return "the version before is gone";
    }
    if (result != WHIT_OK && result != WHIT_ERROR_CANCELLED)
        return "a picture failed";
    return turns->stopped || !engine_is_idle(engine) ? ENGINE_TURNS_STOPPED
                                                     : "pictures take too long";
}

const char *engine_turns_measure(struct engine *engine, struct engine_turns *turns,
                                 struct sample_median *difference)
{
    double differences[PAIRS];
    struct sample_runs *before = &turns->ms[0], *after = &turns->ms[1];
    before->count = after->count = 0;
    turns->engine = engine;
    turns->start_ms = whit_clock_ms();
    whit_result result = sample_in_turns(2, PAIRS, draw_turn, turns);
    uint32_t pairs = before->count < after->count ? before->count : after->count;
    show_again(engine, turns);
    if (pairs < ENGINE_PAIRS_MIN)
        return why_not(engine, turns, result);
    (void)sample_compare(after->values, before->values, pairs, differences, difference);
    return "";
}

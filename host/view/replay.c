#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/clock.h"
#include "base/file.h"
#include "view/prices.h"
#include "view/replay.h"
#include "view/state.h"
#include "view/view_private.h"

static const double LOOK_MS = 20.0; /* time between checks of what is waited for */
static const double TURN_MS = 50.0; /* `wait` moves the replay's clock by steps of this */

struct replay {
    struct event_list list;
    uint32_t at;
    double wait_until_ms; /* end of a `wait`; 0: not waiting */
    bool asked;           /* the window manager was asked to minimise or restore */
};

whit_result replay_open(struct view *view)
{
    const struct view_params *params = view->params;
    if (params->record) {
        view->record = fopen(params->record, "w");
        if (!view->record)
            return log_failure(&view->log, WHIT_ERROR_OUTPUT, "%s: cannot write: %s",
                               params->record, strerror(errno));
        view->record_ms = clock_ms();
        setvbuf(view->record, NULL, _IOLBF, BUFSIZ); /* a line is written as soon as it happened */
        event_to_line(&(struct view_event){.kind = EVENT_CLOCK}, view->record);
    }
    if (!params->replay)
        return WHIT_OK;
    view->replay = array_alloc_zeroed(1, sizeof *view->replay);
    if (!view->replay)
        return WHIT_ERROR_MEMORY;
    return events_load(&view->log, params->replay, &view->replay->list);
}

whit_result replay_close(struct view *view)
{
    if (view->replay)
        events_finish(&view->replay->list);
    free(view->replay);
    bool lost = view->record && ferror(view->record);
    if (view->record && fclose(view->record) != 0)
        lost = true;
    if (lost)
        log_error(&view->log, "%s: cannot be written", view->params->record);
    return lost ? WHIT_ERROR_OUTPUT : WHIT_OK;
}

bool replay_is_over(const struct view *view)
{
    return view->replay && view->replay->at == view->replay->list.count && !view->shot[0];
}

/* ---- What is waited for ---- */

/* Whether the window has its size and shows the engine's latest status, and the engine knows what
   is to be drawn. */
static bool is_settled(const struct view *view, const struct engine_status *status)
{
    uint32_t width, height;
    struct swapchain_info chain;
    window_pixels(view->window, &width, &height);
    swapchain_get_info(view->swapchain, &chain);
    return window_is_settled(view->window) && width == chain.width && height == chain.height &&
           status->stage == view->status.stage &&
           status->change.number == view->status.change.number &&
           strcmp(status->error, view->status.error) == 0 && !view->unasked &&
           !view_is_stale(view) && !view->shot[0];
}

/* Whether no prices are being measured, and all that were measured are drawn. */
static bool is_priced(struct view *view)
{
    if (!prices_are_still(view->prices))
        return false;
    view->dirty |= prices_have_news(view->prices);
    return !view_is_stale(view);
}

/* Whether the best picture is drawn and shown. While an animation plays this never happens, so
   nothing is waited for. */
static bool is_still(struct view *view)
{
    struct engine_status status;
    if (view_plays(view))
        return true;
    engine_get_status(view->engine, &status);
    /* `state` reports view->status, which may be older. */
    return is_settled(view, &status) && !status.drawing && !view_is_moving(view) &&
           view->status.stage == SESSION_DONE && engine_is_still(view->engine) &&
           compare_is_still(view) && is_priced(view) && wish_is_still(view) &&
           (view->frame.number > 0 || status.error[0]);
}

/* Whether a picture of the current settings was shown, of any quality, or there is an error. */
static bool is_shown(const struct view *view)
{
    struct engine_status status;
    const struct engine_frame *frame = &view->frame;
    if (view_plays(view))
        return true;
    engine_get_status(view->engine, &status);
    if (!is_settled(view, &status))
        return false;
    return status.error[0] ? !status.drawing
                           : frame->number > 0 && view->measure.number == frame->number &&
                                 settings_same(&frame->settings, &view->settings);
}

/* Whether what an event waits for has happened. */
static bool is_there(struct view *view, const struct view_event *event)
{
    switch (event->kind) {
    case EVENT_STILL:
        return is_still(view);
    case EVENT_PICTURE:
        return is_shown(view);
    case EVENT_REFINED:
        return engine_is_refined(view->engine) && is_still(view);
    case EVENT_PRICED:
        return prices_are_still(view->panels.measured);
    case EVENT_UNTIL:
        return state_has(view, event->path);
    case EVENT_AWAIT:
        return file_exists(event->path);
    default:
        return true;
    }
}

/* ---- Time ---- */

/* Waits a step at a time, so that held keys and animations go on. True: the time is over. */
static bool wait_step(struct view *view, double ms)
{
    struct replay *replay = view->replay;
    struct view_time *time = &view->time;
    double now_ms = view_now_ms(view);
    if (replay->wait_until_ms <= 0.0)
        replay->wait_until_ms = now_ms + ms;
    if (now_ms < replay->wait_until_ms) {
        if (time->turned)
            time->now_ms = fmin(now_ms + TURN_MS, replay->wait_until_ms);
        return false;
    }
    replay->wait_until_ms = 0.0;
    return true;
}

/* Moves the clock of a replay to the moment at which a picture that moved counts as being at
   rest. */
static void let_stand(struct view *view)
{
    if (view->time.turned && !view_plays(view))
        view->time.now_ms = fmax(view->time.now_ms, view_stands_ms(view));
}

static void use_real_clock(struct view *view)
{
    view->time.ahead_ms = view_now_ms(view) - clock_ms();
    view->time.turned = false;
}

/* ---- Events ---- */

/* Minimises or restores the window; false until the window manager has done it. */
static bool minimise(struct view *view, bool wanted)
{
    uint32_t width, height;
    struct replay *replay = view->replay;
    if (!replay->asked)
        window_set_minimised(view->window, wanted);
    window_pixels(view->window, &width, &height);
    replay->asked = (width == 0) != wanted;
    return !replay->asked;
}

/* Handles an event; false: it has to wait. */
static bool replay_event(struct view *view, const struct view_event *event)
{
    switch (event->kind) {
    case EVENT_WAIT:
        return wait_step(view, event->x);
    case EVENT_STILL:
        let_stand(view);
        return is_there(view, event);
    case EVENT_REFINED:
        let_stand(view);
        engine_set_rest(view->engine, view->settings.refines, true);
        if (!is_there(view, event))
            return false;
        engine_set_rest(view->engine, false, false);
        engine_get_status(view->engine, &view->status); /* with what was measured meanwhile */
        return true;
    case EVENT_PICTURE:
    case EVENT_PRICED:
    case EVENT_UNTIL:
    case EVENT_AWAIT:
        return is_there(view, event);
    case EVENT_CLOCK:
        use_real_clock(view);
        return true;
    case EVENT_STATE:
        state_print(view, event->path, stdout);
        return true;
    case EVENT_SHOT:
        snprintf(view->shot, sizeof view->shot, "%s", event->path);
        view->dirty = true;
        return true;
    case EVENT_CHOOSE:
        return false; /* replay_choose handles it */
    case EVENT_MINIMISE:
    case EVENT_RESTORE:
        return minimise(view, event->kind == EVENT_MINIMISE);
    case EVENT_SIZE: /* the event comes back from the window */
        window_set_pixels(view->window, event->width, event->height);
        return true;
    default:
        input_event(view, event);
        return true;
    }
}

void replay_step(struct view *view)
{
    struct replay *replay = view->replay;
    while (replay && replay->at < replay->list.count && !view->quit && !view->shot[0] &&
           replay_event(view, &replay->list.events[replay->at]))
        ++replay->at;
}

bool replay_choose(struct view *view)
{
    struct replay *replay = view->replay;
    const char *label;
    float x, y;
    uint32_t i = 0;
    if (!replay || replay->at == replay->list.count || view_is_stale(view) || view->quit)
        return false;
    const struct view_event *event = &replay->list.events[replay->at];
    if (event->kind != EVENT_CHOOSE)
        return false;
    while (ui_item(i, &label, &x, &y) && strcmp(label, event->path) != 0)
        ++i;
    if (!ui_item(i, &label, &x, &y))
        return false;
    ++replay->at;
    input_event(view, &(struct view_event){.kind = EVENT_MOVE, .x = (double)x, .y = (double)y});
    for (int down = 1; down >= 0; --down)
        input_event(view, &(struct view_event){.kind = EVENT_BUTTON, .down = down});
    return true;
}

double replay_wait_s(struct view *view)
{
    const struct replay *replay = view->replay;
    if (!replay || replay->at == replay->list.count)
        return HUGE_VAL;
    const struct view_event *event = &replay->list.events[replay->at];
    if (event->kind == EVENT_WAIT && replay->wait_until_ms > 0.0)
        return view->time.turned ? 0.0 : (replay->wait_until_ms - view_now_ms(view)) * 1e-3;
    return is_there(view, event) ? 0.0 : LOOK_MS * 1e-3;
}

void record_event(struct view *view, const struct view_event *event)
{
    double now_ms = clock_ms();
    if (!view->record || event->kind == EVENT_REFRESH)
        return;
    if (now_ms - view->record_ms >= 1.0) {
        event_to_line(&(struct view_event){.kind = EVENT_WAIT, .x = now_ms - view->record_ms},
                      view->record);
        view->record_ms = now_ms;
    }
    event_to_line(event, view->record);
}

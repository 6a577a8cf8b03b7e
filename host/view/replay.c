/* Events from a file, and into one. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/clock.h"
#include "view/prices.h"
#include "view/view_private.h"

static const double MANAGER_MS = 1000.0;
static const double LOOK_MS = 20.0; /* between looks whether the picture is still by now */

struct replay {
    struct view_event *events;
    uint32_t count, at;
    double wait_until_ms; /* 0: not waiting */
    bool awaits;          /* a picture other than `seen` */
    uint64_t seen;        /* number of a picture */
};

whit_result replay_open(struct view *view)
{
    const struct view_params *params = view->params;
    if (params->record) {
        view->record = fopen(params->record, "w");
        view->record_ms = clock_ms();
        if (!view->record) {
            log_error(&view->log, "%s: cannot be written", params->record);
            return WHIT_ERROR_OUTPUT;
        }
    }
    if (!params->replay)
        return WHIT_OK;
    view->replay = array_alloc_zeroed(1, sizeof *view->replay);
    if (!view->replay)
        return WHIT_ERROR_MEMORY;
    return events_load(&view->log, params->replay, &view->replay->events, &view->replay->count);
}

void replay_close(struct view *view)
{
    if (view->replay)
        free(view->replay->events);
    free(view->replay);
    view->replay = NULL;
    if (view->record && fclose(view->record) != 0)
        log_error(&view->log, "%s: cannot be written", view->params->record);
    view->record = NULL;
}

bool replay_is_over(const struct view *view)
{
    return view->replay && view->replay->at == view->replay->count && !view->shot[0];
}

/* As good as it gets, and seen. While the animation plays it never is: then nothing is waited for.
 */
static bool is_still(const struct view *view)
{
    uint32_t width, height;
    struct swapchain_info chain;
    if (view_plays(view))
        return true;
    window_pixels(view->window, &width, &height);
    swapchain_get_info(view->swapchain, &chain);
    if (width != chain.width || height != chain.height)
        return false; /* the window's own event is on its way */
    struct engine_status status;
    engine_get_status(view->engine, &status);
    if (status.drawing || status.stage != view->status.stage ||
        strcmp(status.error, view->status.error) != 0)
        return false; /* the window does not know as yet */
    return !view_is_moving(view, clock_ms()) && engine_is_still(view->engine) &&
           compare_is_still(view) && prices_are_still(view->prices) && wish_is_still(view) &&
           !view->dirty && !view->shot[0] && (view->frame.number > 0 || view->status.error[0]);
}

/* The window manager does it, where there is one: false until it has. */
static bool minimise(struct view *view, bool wanted, double now_ms)
{
    struct replay *replay = view->replay;
    uint32_t width, height;
    if (replay->wait_until_ms <= 0.0) {
        replay->wait_until_ms = now_ms + MANAGER_MS;
        window_set_minimised(view->window, wanted);
    }
    window_pixels(view->window, &width, &height);
    if ((width == 0) != wanted && now_ms < replay->wait_until_ms)
        return false;
    replay->wait_until_ms = 0.0;
    return true;
}

/* Until a picture was shown that was not there when this event came. */
static bool is_next_shown(struct view *view)
{
    struct replay *replay = view->replay;
    if (!replay->awaits)
        replay->seen = view->measure.number;
    replay->awaits = view->measure.number == replay->seen;
    return !replay->awaits;
}

/* False where the event has to wait. */
static bool replay_event(struct view *view, const struct view_event *event, double now_ms)
{
    struct replay *replay = view->replay;
    switch (event->kind) {
    case EVENT_WAIT:
        if (replay->wait_until_ms <= 0.0)
            replay->wait_until_ms = now_ms + event->x;
        if (now_ms < replay->wait_until_ms)
            return false;
        replay->wait_until_ms = 0.0;
        return true;
    case EVENT_STILL:
        return is_still(view);
    case EVENT_PICTURE:
        return is_next_shown(view);
    case EVENT_PRICED:
        return prices_are_still(view->panels.measured);
    case EVENT_STATE:
        state_print(view, event->path, stdout);
        return true;
    case EVENT_SHOT:
        snprintf(view->shot, sizeof view->shot, "%s", event->path);
        view->dirty = true;
        return true;
    case EVENT_MINIMISE:
    case EVENT_RESTORE:
        return minimise(view, event->kind == EVENT_MINIMISE, now_ms);
    case EVENT_SIZE: /* comes back from the window */
        window_set_pixels(view->window, event->width, event->height);
        return true;
    default:
        input_event(view, event);
        return true;
    }
}

bool replay_step(struct view *view, double now_ms)
{
    struct replay *replay = view->replay;
    if (!replay)
        return false;
    while (replay->at < replay->count && !view->quit && !view->shot[0]) {
        if (!replay_event(view, &replay->events[replay->at], now_ms))
            break;
        ++replay->at;
    }
    return replay->at < replay->count;
}

double replay_wait_s(const struct view *view, double now_ms)
{
    const struct replay *replay = view->replay;
    if (!replay || replay->at == replay->count)
        return HUGE_VAL;
    bool waits = replay->events[replay->at].kind == EVENT_WAIT && replay->wait_until_ms > 0.0;
    double left_ms = waits ? replay->wait_until_ms - now_ms : LOOK_MS;
    return left_ms > 0.0 ? left_ms * 1e-3 : 0.0;
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

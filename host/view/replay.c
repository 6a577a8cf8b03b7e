/* Events from a file, and into one. */
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/clock.h"
#include "view/view_private.h"

struct replay {
    struct view_event *events;
    uint32_t count, at;
    double wait_until_ms; /* 0: not waiting */
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

/* As good as it gets, and seen. */
static bool is_still(const struct view *view)
{
    return !view->asked_moving && !view_is_moving(view, clock_ms()) &&
           engine_is_still(view->engine) && compare_is_still(view) && !view->dirty &&
           !view->shot[0] && (view->frame.number > 0 || view->status.error[0]);
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
    case EVENT_STATE:
        state_print(view, stdout);
        return true;
    case EVENT_SHOT:
        memcpy(view->shot, event->path, sizeof view->shot);
        view->dirty = true;
        return true;
    case EVENT_MINIMISE:
    case EVENT_RESTORE:
        window_set_minimised(view->window, event->kind == EVENT_MINIMISE);
        return true;
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

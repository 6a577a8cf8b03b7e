#include <string.h>

#include "base/clock.h"
#include "base/sample.h"
#include "view/measure.h"
#include "view/view_private.h"

/* Without input for longer than this, nobody waits for the window to be drawn. */
static const double INPUT_MS = 50.0;

static void note(struct view_figures *figures, double value)
{
    if (figures->count < FIGURES_MAX)
        figures->values[figures->count] = value;
    ++figures->count;
}

double figures_quantile(struct view_figures *figures, double share)
{
    uint32_t count = figures->count < FIGURES_MAX ? figures->count : FIGURES_MAX;
    sample_sort(figures->values, count);
    return sample_quantile(figures->values, count, share);
}

void measure_begin(struct view *view)
{
    struct view_measure *measure = &view->measure;
    double first_ms = measure->first_ms;
    uint64_t number = measure->number;
    memset(measure, 0, sizeof *measure);
    measure->first_ms = first_ms;
    measure->number = number;
    measure->start_ms = clock_ms();
    measure->cpu_ms = clock_cpu_ms();
}

/* Counts a picture that is shown for the first time. */
static void count_new(struct view_measure *measure, const struct engine_frame *frame, double now_ms)
{
    double render_ms = engine_drawn_ms(&frame->stats);
    measure->number = frame->number;
    if (frame->whole)
        note(&measure->whole, render_ms);
    if (frame->moving) {
        note(&measure->quick, render_ms);
        note(&measure->size, frame->divisor);
        note(&measure->latency, now_ms - frame->asked_ms);
        if (measure->last_ms > 0.0)
            note(&measure->gap, now_ms - measure->last_ms);
    }
    measure->last_ms = frame->moving ? now_ms : 0.0;
}

void measure_shown(struct view *view)
{
    struct view_measure *measure = &view->measure;
    struct swapchain_info chain;
    double now_ms = clock_ms();
    swapchain_get_info(view->swapchain, &chain);
    if (measure->first_ms <= 0.0)
        measure->first_ms = now_ms;
    if (measure->shown_ms > 0.0 && now_ms - measure->input_ms < INPUT_MS)
        note(&measure->between, now_ms - measure->shown_ms);
    measure->shown_ms = now_ms;
    ++measure->drawn;
    note(&measure->present, chain.present_ms);
    if (view->frame.number > measure->number)
        count_new(measure, &view->frame, now_ms);
}

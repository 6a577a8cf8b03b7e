#include "view/price_strip.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "view/ui.h"

enum { ABOUT = 160 };
static const uint32_t COLOR_USUAL = 0xFF4C8CFFu, COLOR_BEST = 0xFFE9B456u, COLOR_REST = 0xFF8A8A85u;
static const float MARGIN = 0.07f; /* margin on each side, as a share of the box */
static const double ALL_TICKS = 100.0;

/* A row of the price list, and its point in the plot. */
struct place {
    const struct cost_row *row;
    double ms, flip;
    char name[COST_NAME], about[ABOUT];
};
struct places {
    struct place list[COST_ROWS_MAX];
    uint32_t count;
    double ms[2], flip[2]; /* smallest and largest value */
};

static int compare_places(const void *a, const void *b)
{
    const struct place *x = a, *y = b;
    return (x->ms > y->ms) - (x->ms < y->ms);
}

/* Collects the rows that have a point, sorted by time, as the line joins them. */
static void collect(const struct cost_report *report, const struct price_strip *strip,
                    struct places *places)
{
    char name[COST_NAME];
    double least = INFINITY;
    places->count = 0;
    for (uint32_t i = 0; i < report->row_count; ++i) {
        const struct cost_row *row = &report->rows[i];
        struct place *place = &places->list[places->count];
        if (!row->measured || !(row->ms[report->clock] > 0.0) || !cost_is_judged(report, row))
            continue;
        *place = (struct place){.row = row,
                                .ms = row->ms[report->clock],
                                .flip = cost_error_of(&row->error, COST_FLIP)};
        least = place->flip > 0.0 ? fmin(least, place->flip) : least;
        price_strip_name(strip, report, row, name);
        memcpy(place->name, name, sizeof name);
        snprintf(place->about, ABOUT, "%s: %.4g ms, FLIP %.3g", name, place->ms, place->flip);
        ++places->count;
    }
    qsort(places->list, places->count, sizeof *places->list, compare_places);
    places->flip[0] = places->ms[0] = INFINITY;
    places->flip[1] = places->ms[1] = 0.0;
    for (uint32_t i = 0; i < places->count; ++i) {
        struct place *place = &places->list[i];
        place->flip = fmax(place->flip, least < INFINITY ? 0.5 * least : 1e-4); /* avoids log(0) */
        places->ms[0] = fmin(places->ms[0], place->ms);
        places->ms[1] = fmax(places->ms[1], place->ms);
        places->flip[0] = fmin(places->flip[0], place->flip);
        places->flip[1] = fmax(places->flip[1], place->flip);
    }
}

static float inside(double value, const double range[2])
{
    return MARGIN + (1.0f - 2.0f * MARGIN) * ui_log_place(value, range[0], range[1]);
}

/* Lists powers of 10 as ticks, and in small ranges also their multiples by 2 and 5. */
static uint32_t list_ticks(const double range[2], struct ui_tick ticks[UI_TICKS_MAX])
{
    static const double parts[] = {1.0, 2.0, 5.0};
    uint32_t count = 0, all = range[1] / range[0] < ALL_TICKS ? 3 : 1;
    if (range[0] == range[1])
        return 0;
    for (int e = (int)floor(log10(range[0])); e <= (int)ceil(log10(range[1])); ++e) {
        for (uint32_t i = 0; i < all && count < UI_TICKS_MAX; ++i) {
            double value = parts[i] * pow(10.0, e);
            float at = inside(value, range);
            if (at < 0.0f || at > 1.0f)
                continue;
            snprintf(ticks[count].label, sizeof ticks[count].label, "%.6g", value);
            ticks[count++].at = at;
        }
    }
    return count;
}

void price_plot_draw(const struct cost_report *report, const struct price_strip *strip)
{
    struct places places;
    struct ui_point points[COST_ROWS_MAX];
    collect(report, strip, &places);
    for (uint32_t i = 0; i < places.count; ++i) {
        const struct place *place = &places.list[i];
        bool usual = place->row == report->rows, best = place->row->best;
        points[i] = (struct ui_point){.x = inside(place->ms, places.ms),
                                      .y = inside(place->flip, places.flip),
                                      .color = usual  ? COLOR_USUAL
                                               : best ? COLOR_BEST
                                                      : COLOR_REST,
                                      .radius = usual  ? 5.0f
                                                : best ? 3.5f
                                                       : 2.5f,
                                      .joined = best,
                                      .name = usual || best ? place->name : NULL,
                                      .about = place->about};
    }
    struct ui_plot plot = {
        .width = 27.0f, .height = 11.0f, .line_color = COLOR_BEST, .points = points};
    plot.count = places.count;
    plot.tick_count[0] = list_ticks(places.ms, plot.ticks[0]);
    plot.tick_count[1] = list_ticks(places.flip, plot.ticks[1]);
    ui_plot_points(&plot);
    ui_text_dim("FLIP over ms of %s; nothing beats the line.", cost_time_name(report));
}

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "view/price_panel.h"
#include "view/prices.h"
#include "view/view_private.h"

static const double SPEND_S = 12.0;
enum { RANGE = 32 };

void prices_leave(struct view *view, struct prices **prices)
{
    uint32_t at = 0;
    if (!*prices)
        return;
    prices_cancel(*prices);
    while (at < LEAVING_MAX - 1 && view->leaving[at])
        ++at;
    prices_stop(view->leaving[at]); /* if all places are taken, the last one is waited for */
    view->leaving[at] = *prices;
    *prices = NULL;
}

void prices_part(struct view *view)
{
    for (uint32_t i = 0; i < LEAVING_MAX; ++i) {
        if (view->leaving[i] && prices_are_still(view->leaving[i])) {
            prices_stop(view->leaving[i]);
            view->leaving[i] = NULL;
        }
    }
}

void price_switch(struct view *view)
{
    double spend_s = view->params->spend_s;
    view->prices_open = !view->prices_open;
    if (!view->prices_open) {
        prices_leave(view, &view->prices);
    } else if (!view->scene) {
        view->prices_open = false;
    } else if (settings_compiles(&view->settings)) {
        view->prices_open = false;
        view_say(view, "prices are measured against the reference, which has no --shader");
    } else {
        view->prices =
            prices_start(&(struct prices_params){.settings = view->frame.settings,
                                                 .scene = view->scene,
                                                 .seconds = spend_s > 0.0 ? spend_s : SPEND_S,
                                                 .strip = true});
        if (!view->prices)
            view_say(view, "out of memory");
    }
}

/* Applies the setting of a row to the window's settings. Settings of trees have keys of their
   own. */
static void use(struct view *view, const struct cost_row *row)
{
    knob_apply(&knob_table[row->knob_index], row->setting_index, &view->settings);
    view->dirty = true;
}

/* The time of a row, as a multiple of the usual row's. */
static double of_usual(const struct cost_report *report, const struct cost_row *row)
{
    return row->ms[report->clock] / report->rows[0].ms[report->clock];
}

static void draw_row(struct view *view, const struct cost_report *report,
                     const struct cost_row *row, uint32_t index)
{
    char label[COST_NAME + 16], text[COST_NOTE];
    const char *name = row->setting[0] ? row->setting : "as it is";
    bool usable = row->knob_index < KNOBS && knob_level(&knob_table[row->knob_index]) < KNOB_TREE;
    ui_table_next();
    snprintf(label, sizeof label, "%s##price%u", name, index);
    if (!usable)
        ui_text("%s", name);
    else if (ui_selectable(label, false))
        use(view, row);
    ui_table_next();
    if (!row->measured)
        ui_text_dim("not measured");
    else if (index > 0 && row->price.verdict == 0)
        ui_text_dim("as before");
    else
        ui_text_color(row->price.verdict < 0 ? UI_COLOR_GOOD : UI_COLOR_TEXT, "%.1f ms",
                      row->ms[report->clock]);
    if (row->broken)
        snprintf(text, sizeof text, "changed %llu pixels", (unsigned long long)row->pixels_changed);
    else if (row->measured && !cost_is_judged(report, row))
        snprintf(text, sizeof text, "FLIP unknown");
    else if (row->measured)
        snprintf(text, sizeof text, "FLIP %.3g", cost_error_of(&row->error, COST_FLIP));
    else
        snprintf(text, sizeof text, "%s", row->note);
    ui_cell(row->broken ? UI_COLOR_ERROR : UI_COLOR_TEXT, text);
    ui_cell(UI_COLOR_GOOD, row->best && cost_is_judged(report, row) ? "*" : "");
}

static void widen(double range[2], double value)
{
    range[0] = fmin(range[0], value);
    range[1] = fmax(range[1], value);
}

/* Writes "0.46 to 1.16", one number if both look the same, or "unknown" for an empty range. */
static const char *write_range(const double range[2], char text[RANGE])
{
    char low[12], high[12];
    snprintf(low, sizeof low, "%.3g", range[0]);
    snprintf(high, sizeof high, "%.3g", range[1]);
    bool one = strcmp(low, high) == 0;
    if (range[0] > range[1])
        snprintf(text, RANGE, "unknown");
    else
        snprintf(text, RANGE, "%s%s%s", low, one ? "" : " to ", one ? "" : high);
    return text;
}

/* Begins the fold of a knob, whose rows are `first` to `end` - 1, with the ranges that they span:
   "depth: x 0.46 to 1.16, FLIP 0.0744 to 0.35". */
static bool begin_knob(const struct cost_report *report, uint32_t first, uint32_t end)
{
    const char *knob = report->rows[first].knob;
    double ratio[2] = {HUGE_VAL, 0.0}, flip[2] = {HUGE_VAL, 0.0};
    char label[160], times[RANGE], flips[RANGE];
    bool best = false;
    for (uint32_t i = first; i < end; ++i) {
        const struct cost_row *row = &report->rows[i];
        if (row->measured)
            widen(ratio, of_usual(report, row));
        if (row->measured && cost_is_judged(report, row)) {
            best = best || row->best;
            widen(flip, cost_error_of(&row->error, COST_FLIP));
        }
    }
    if (ratio[0] > ratio[1])
        snprintf(label, sizeof label, "%s: not measured##knob", knob);
    else
        snprintf(label, sizeof label, "%s: x %s, FLIP %s##knob", knob, write_range(ratio, times),
                 write_range(flip, flips));
    return ui_fold(label, best || first == 1); /* the first fold shows that there are rows */
}

/* Draws the rows, folded by knob. */
static void draw_table(struct view *view, const struct cost_report *report)
{
    static const int widths[] = {19, 12, 18, 1};
    for (uint32_t i = 0, end; i < report->row_count; i = end) {
        const char *knob = report->rows[i].knob;
        for (end = i + 1; end < report->row_count && strcmp(report->rows[end].knob, knob) == 0;)
            ++end;
        if (!begin_knob(report, i, end) || !ui_table_begin(knob, 4))
            continue;
        ui_table_columns(NULL, widths, 4);
        for (uint32_t k = i; k < end; ++k)
            draw_row(view, report, &report->rows[k], k);
        ui_table_end();
    }
}

static bool has_unknown(const struct cost_report *report)
{
    bool has = false;
    for (uint32_t i = 0; i < report->row_count; ++i)
        has = has || (report->rows[i].measured && !cost_is_judged(report, &report->rows[i]));
    return has;
}

static void draw_report(struct view *view, const struct cost_report *report,
                        const struct price_strip *strip)
{
    char sentence[COST_SENTENCE_BYTES];
    cost_sentence(report, sentence);
    ui_paragraph(sentence);
    price_strip_draw(strip, report);
    ui_text_dim("By the clock; FLIP to the picture in double, %u samples.",
                report->reference_samples);
    if (has_unknown(report))
        ui_text_dim("FLIP unknown: not fewer samples than those.");
    price_plot_draw(report, strip);
    draw_table(view, report);
    ui_text_dim("*: nothing is cheaper and as right.");
    ui_text_dim("Click a setting to take it; `whit cost` measures longer.");
}

void price_draw(struct view *view)
{
    struct prices_state state;
    bool open = true;
    if (!view->prices)
        return;
    prices_get_state(view->prices, &state);
    if (ui_window_begin("Prices", 1.0f, 0.0f, 440.0f, 640.0f, false, &open)) {
        if (!settings_same_place(state.settings, &view->settings))
            ui_text_color(UI_COLOR_WARNING, "of another view: press P twice");
        if (!state.finished) {
            char text[PRICES_TEXT + 32];
            snprintf(text, sizeof text, "%.60s, %.0f s", state.what, state.seconds_left);
            ui_progress((float)state.done, text);
        } else if (state.report) {
            draw_report(view, state.report, state.strip);
        } else {
            ui_text_color(UI_COLOR_ERROR, "%s", state.what);
        }
    }
    ui_panel_end();
    if (!open)
        price_switch(view);
}

/* Key P: the price list of this view, beside each switch. */
#include <stdio.h>
#include <string.h>

#include "view/price_panel.h"
#include "view/prices.h"
#include "view/view_private.h"

static const double SPEND_S = 12.0;
enum { TABLE_DRAWS = 3 };
static const uint32_t COLOR_GOOD = 0xFFD0E090u, COLOR_WARNING = 0xFF40C0FFu,
                      COLOR_ERROR = 0xFF6070FFu;

void prices_leave(struct view *view, struct prices *prices)
{
    uint32_t at = 0;
    if (!prices)
        return;
    prices_cancel(prices);
    while (at < LEAVING_MAX - 1 && view->leaving[at])
        ++at;
    prices_stop(view->leaving[at]); /* where there are many at once, the last one is waited for */
    view->leaving[at] = prices;
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
        prices_leave(view, view->prices);
        view->prices = NULL;
    } else if (!view->scene) {
        view->prices_open = false;
    } else if (settings_compiles(&view->settings)) {
        view->prices_open = false;
        view_say(view, "prices are measured against the reference, which has no --shader");
    } else {
        view->prices_drawn = 0;
        view->prices =
            prices_start(&(struct prices_params){.settings = &view->frame.settings,
                                                 .scene = view->scene,
                                                 .seconds = spend_s > 0.0 ? spend_s : SPEND_S,
                                                 .wake = window_wake,
                                                 .wake_user = view->window});
        if (!view->prices)
            view_say(view, "out of memory");
    }
}

/* What the setting says, on top of what the window has. Trees have keys of their own. */
static void use(struct view *view, const struct cost_row *row)
{
    uint32_t count;
    const struct knob *knob = &knob_table(&count)[row->knob_index];
    knob_apply(knob, row->setting_index, &view->settings);
    view_changed(view);
}

static void draw_row(struct view *view, const struct cost_report *report,
                     const struct cost_row *row, uint32_t index)
{
    uint32_t count;
    const struct knob *knobs = knob_table(&count);
    const whit_difference *error = &row->error;
    char label[COST_NAME + 16];
    bool usable = row->knob_index < count && knob_level(&knobs[row->knob_index]) < KNOB_TREE;
    ui_table_next();
    ui_text_dim("%s", row->knob);
    ui_table_next();
    snprintf(label, sizeof label, "%s##price%u", row->setting, index);
    if (!usable)
        ui_text("%s", row->setting);
    else if (ui_selectable(label, false))
        use(view, row);
    if (!row->measured) {
        ui_table_next();
        ui_text_dim("%.40s", row->note);
        for (int i = 0; i < 2; ++i)
            ui_table_next();
        return;
    }
    ui_table_next();
    if (index > 0 && row->price.verdict == 0)
        ui_text_dim("as before");
    else
        ui_text_color(row->price.verdict < 0 ? COLOR_GOOD : 0xFFFFFFFFu, "%.1f ms",
                      row->ms[report->clock]);
    ui_table_next();
    if (row->broken)
        ui_text_color(COLOR_ERROR, "changed %llu pixels", (unsigned long long)row->pixels_changed);
    else
        ui_text("%.3g", cost_error_of(error, COST_FLIP));
    ui_table_next();
    ui_text_color(COLOR_GOOD, "%s", row->best ? "*" : "");
}

static void draw_table(struct view *view, const struct cost_report *report)
{
    const char *const columns[] = {"knob", "setting", cost_time_name(report), "FLIP", "best"};
    char sentence[COST_SENTENCE_BYTES];
    cost_sentence(report, sentence);
    ui_paragraph(sentence);
    if (ui_table_begin("prices", 5)) {
        ui_table_header(columns, 5);
        for (uint32_t i = 0; i < report->row_count; ++i)
            draw_row(view, report, &report->rows[i], i);
        ui_table_end();
    }
    ui_text_dim("FLIP: to the picture in double, %u samples.", report->reference_samples);
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
    if (state.finished && view->prices_drawn < TABLE_DRAWS) {
        ++view->prices_drawn; /* a table finds its columns in the draws after its first */
        view->dirty = true;
    }
    if (ui_window_begin("Prices", 1.0f, 0.0f, 420.0f, 380.0f, false, &open)) {
        if (!settings_same_place(&state.settings, &view->settings))
            ui_text_color(COLOR_WARNING, "of another view: press P twice");
        if (!state.finished) {
            char text[PRICES_TEXT + 32];
            snprintf(text, sizeof text, "%.60s, %.0f s", state.what, state.seconds_left);
            ui_progress((float)state.done, text);
        } else if (state.report) {
            draw_table(view, state.report);
        } else {
            ui_text_color(COLOR_ERROR, "%s", state.what);
        }
    }
    ui_panel_end();
    if (!open)
        price_switch(view);
}

#include "view/wish.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "view/price_panel.h"
#include "view/view_private.h"

static const double SPEND_S = 20.0;
enum { TRIES_MAX = 3 };

const char *wish_stage_name(enum wish_stage stage)
{
    static const char *const names[] = {"none",   "waits",     "measures", "tries",
                                        "chosen", "no choice", "failed"};
    return names[stage];
}

/* ---- Settings ---- */

/* Resets the settings that a choice may change. */
static void set_usual(struct settings *settings)
{
    const struct settings usual = settings_usual();
    settings_set_light(settings, &usual);
}

/* Whether the user has changed settings since they were chosen. */
static bool is_left(const struct view *view)
{
    return !settings_same_light(&view->wish.settings, &view->settings);
}

/* ---- Choosing ---- */

static struct cost_choice find_choice(const struct view *view)
{
    const struct settings *asked = &view->params->settings;
    const struct cost_report *report = &view->wish.figures->report;
    bool within = asked->budget_ms > 0.0;
    double limit = within ? asked->budget_ms / view->wish.slower : asked->max_error;
    const struct cost_goal goal = {
        .kind = within ? COST_WITHIN : COST_UNDER, .metric = COST_RMSE, .limit = COST_ROOM * limit};
    return within && view->wish.tries == 0 ? cost_choose_budget(report, limit, false)
                                           : cost_choose(report, &goal);
}

static void take_choice(struct view *view, double predicted_ms)
{
    struct wish *wish = &view->wish;
    const struct cost_choice *choice = &wish->figures->choice;
    cost_choice_text(choice, wish->text, sizeof wish->text);
    if (!wish->text[0])
        snprintf(wish->text, sizeof wish->text, "what is usual");
    wish->predicted_ms = predicted_ms;
    wish->predicted_error = choice->error;
    set_usual(&view->settings);
    cost_choice_apply(choice, &view->settings);
    wish->settings = view->settings;
    wish->took_ms = 0.0;
    wish->stage = WISH_TRIES;
    ++wish->tries;
}

static void choose(struct view *view)
{
    struct wish *wish = &view->wish;
    const struct cost_choice choice = find_choice(view);
    view->dirty = true;
    if (!choice.found) {
        wish->stage = WISH_NO_CHOICE;
        snprintf(wish->text, sizeof wish->text,
                 view->params->settings.budget_ms > 0.0 ? "no setting takes so little here"
                                                        : "no setting is as right as that here");
        return;
    }
    wish->figures->choice = choice;
    take_choice(view, choice.ms * wish->slower);
}

static void fail(struct wish *wish, const char *why)
{
    wish->stage = WISH_FAILED;
    snprintf(wish->text, sizeof wish->text, "%s", why);
}

/* The key by which figures are kept: the settings of their picture, with the limit that is asked
   for. */
static struct cost_place place_of(const struct view *view, struct settings *settings)
{
    *settings = view->wish.place;
    settings->budget_ms = view->params->settings.budget_ms;
    settings->max_error = view->params->settings.max_error;
    return (struct cost_place){
        .settings = settings, .scene = view->scene->info, .device = view->frame.device};
}

static void save(const struct view *view)
{
    const struct view_params *params = view->params;
    const struct wish *wish = &view->wish;
    struct settings settings;
    const struct cost_place place = place_of(view, &settings);
    struct cost_kept_figures *figures = wish->figures;
    bool found = figures->choice.found;
    figures->choice.found = found && params->settings.budget_ms > 0.0 && wish->stage == WISH_CHOSEN;
    figures->choice_ms = wish->took_ms;
    params->save_figures(&place, figures);
    figures->choice.found = found;
}

/* Chooses by figures of an earlier run, or takes its choice. False: there are no figures. */
static bool choose_as_before(struct view *view)
{
    const struct view_params *params = view->params;
    struct wish *wish = &view->wish;
    struct settings settings;
    const struct cost_place place = place_of(view, &settings);
    if (wish->fresh || !params->load_figures(&place, wish->figures))
        return false;
    wish->known = wish->figures->choice.found;
    if (wish->known)
        take_choice(view, wish->figures->choice_ms);
    else
        choose(view);
    view->dirty = true;
    return true;
}

static void measure(struct view *view)
{
    struct wish *wish = &view->wish;
    struct settings usual = view->frame.settings;
    double spend_s = view->params->spend_s;
    set_usual(&usual);
    wish->scene = view->scene;
    wish->slower = 1.0;
    wish->tries = 0;
    wish->place = usual;
    free(wish->figures);
    wish->figures = calloc(1, sizeof *wish->figures);
    if (wish->figures && choose_as_before(view))
        return;
    wish->prices =
        prices_start(&(struct prices_params){.settings = usual,
                                             .scene = view->scene,
                                             .seconds = spend_s > 0.0 ? spend_s : SPEND_S,
                                             .knobs = knobs_of_light()});
    wish->stage = WISH_MEASURES;
    wish->text[0] = '\0';
    if (!wish->prices || !wish->figures)
        fail(wish, "out of memory");
    view->dirty = true;
}

static void take_figures(struct view *view)
{
    struct wish *wish = &view->wish;
    struct prices_state state;
    view->dirty |= prices_have_news(wish->prices);
    prices_get_state(wish->prices, &state);
    if (!state.finished)
        return;
    if (state.report && state.report->complete) {
        wish->figures->report = *state.report;
        wish->figures->report.reference = NULL; /* owned by wish->prices */
        save(view);
        choose(view);
    } else {
        fail(wish, state.what);
    }
}

/* Checks the time of the chosen settings. If it is over the budget, or far below the prediction,
   chooses again with times scaled by what was measured. */
static void try_choice(struct view *view)
{
    struct wish *wish = &view->wish;
    const struct engine_frame *frame = &view->frame;
    double budget_ms = view->params->settings.budget_ms, took_ms = frame->stats.render_ms;
    if (!frame->whole || !settings_same(&frame->settings, &view->settings))
        return;
    wish->took_ms = took_ms;
    wish->stage = WISH_CHOSEN;
    view->dirty = true;
    bool fits = took_ms <= budget_ms && took_ms >= COST_TOO_LITTLE * wish->predicted_ms;
    if (wish->known || budget_ms <= 0.0 || is_left(view))
        return;
    if (!fits && wish->tries < TRIES_MAX) {
        wish->slower *= took_ms / wish->predicted_ms;
        choose(view);
        if (wish->stage == WISH_TRIES && !settings_same(&frame->settings, &view->settings))
            return;
        wish->took_ms = took_ms; /* there are no other settings to try */
        wish->stage = WISH_CHOSEN;
    }
    save(view);
}

void wish_again(struct view *view, bool fresh)
{
    prices_leave(view, &view->wish.prices);
    view->wish.stage = WISH_WAITS;
    view->wish.fresh = fresh;
    view->wish.known = false;
    view->dirty = true;
}

void wish_begin(struct view *view)
{
    const struct settings *asked = &view->params->settings;
    bool any = asked->budget_ms > 0.0 || asked->max_error > 0.0;
    view->wish.stage = any ? WISH_WAITS : WISH_NONE;
    view->wish.fresh = view->params->fresh;
}

void wish_step(struct view *view)
{
    struct wish *wish = &view->wish;
    if (wish->stage == WISH_NONE || !view->scene)
        return;
    if (wish->stage != WISH_WAITS && wish->scene != view->scene)
        wish_again(view, view->params->fresh);
    if (wish->stage == WISH_WAITS && view->frame.whole && !view->status.drawing &&
        view->measure.number == view->frame.number)
        measure(view);
    else if (wish->stage == WISH_MEASURES)
        take_figures(view);
    else if (wish->stage == WISH_TRIES)
        try_choice(view);
}

bool wish_is_still(const struct view *view)
{
    enum wish_stage stage = view->wish.stage;
    bool failed = view->status.error[0] != '\0';
    return failed || (stage != WISH_WAITS && stage != WISH_MEASURES && stage != WISH_TRIES);
}

void wish_finish(struct view *view)
{
    prices_stop(view->wish.prices);
    free(view->wish.figures);
    view->wish.prices = NULL;
    view->wish.figures = NULL;
}

/* ---- Figures ---- */

static void draw_chosen(const struct view *view)
{
    const struct wish *wish = &view->wish;
    double budget_ms = view->params->settings.budget_ms;
    ui_text_color(UI_COLOR_GOOD, "%s", wish->text);
    ui_text("predicted %.4g ms, RMSE %.3g", wish->predicted_ms, wish->predicted_error);
    if (wish->took_ms > 0.0)
        ui_text_color(budget_ms > 0.0 && wish->took_ms > budget_ms ? UI_COLOR_WARNING
                                                                   : UI_COLOR_GOOD,
                      "it took %.4g ms", wish->took_ms);
    if (wish->known)
        ui_text_dim("kept, by figures of %s", wish->figures->made);
    if (is_left(view))
        ui_text_dim("changed since");
    else if (!settings_same_camera(&wish->settings, &view->settings))
        ui_text_dim("measured for another view");
}

void wish_draw(const struct view *view)
{
    const struct wish *wish = &view->wish;
    const struct settings *asked = &view->params->settings;
    struct prices_state state;
    if (wish->stage == WISH_NONE)
        return;
    ui_separator();
    if (asked->budget_ms > 0.0)
        ui_text("the best within %.4g ms:", asked->budget_ms);
    else
        ui_text("the cheapest with an RMSE of at most %.3g:", asked->max_error);
    if (wish->stage == WISH_WAITS) {
        ui_text_dim("measured once the picture is whole");
    } else if (wish->stage == WISH_MEASURES) {
        prices_get_state(wish->prices, &state);
        ui_text_dim("measuring %.40s, %.0f s", state.what, state.seconds_left);
    } else if (wish->stage == WISH_NO_CHOICE || wish->stage == WISH_FAILED) {
        ui_text_color(UI_COLOR_WARNING, "%s", wish->text);
    } else {
        draw_chosen(view);
    }
}

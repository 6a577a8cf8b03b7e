/* The state of the viewer as one line of JSON: for tests, which read it between events. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include <jansson.h>

#include "base/clock.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/platform.h"
#include "base/text.h"
#include "view/keys.h"
#include "view/prices.h"
#include "view/scenes.h"
#include "view/state.h"
#include "view/view_private.h"

static void put_text(json_t *object, const char *name, const char *text)
{
    char shown[4096];
    json_t *value = json_string(text ? text : "");
    if (!value) /* the text is no UTF-8 */
        value = json_string(whit_text_show(text, shown, sizeof shown));
    json_object_set_new(object, name, value);
}

static void put_count(json_t *object, const char *name, uint64_t count)
{
    json_object_set_new(object, name, json_integer((json_int_t)count));
}

static void put_number(json_t *object, const char *name, double number)
{
    json_object_set_new(object, name, json_real(number));
}

static void put_bool(json_t *object, const char *name, bool value)
{
    json_object_set_new(object, name, json_boolean(value));
}

static void put_hash(json_t *object, const char *name, uint64_t hash)
{
    char text[17];
    snprintf(text, sizeof text, "%016" PRIx64, hash);
    put_text(object, name, text);
}

static uint64_t hash_of(const void *data, size_t bytes)
{
    return data ? hash_bytes(HASH_START, data, bytes) : 0;
}

static json_t *shader_json(const struct shaders *shaders)
{
    const struct shader_ref *shown = shaders->shown;
    if (!shown)
        return json_null();
    json_t *object = json_object();
    put_hash(object, "hash", shown->info.hash);
    put_count(object, "files", shown->info.file_count);
    put_count(object, "sliders", shown->info.slider_count);
    put_text(object, "changed", shaders->line);
    put_count(object, "first", shaders->counts.first);
    put_count(object, "whole", shaders->counts.whole);
    put_count(object, "refused", shaders->counts.refused);
    put_number(object, "saved_ms", shaders->wait.saved_ms);
    put_number(object, "first_ms", shaders->wait.first_ms);
    put_number(object, "whole_ms", shaders->wait.whole_ms);
    put_number(object, "error_ms", shaders->wait.error_ms);
    return object;
}

/* Time of all stages in ms; -1: they were not timed. */
static double stages_ms(const whit_stats *stats)
{
    double sum = 0.0;
    bool timed = false;
    for (int i = 0; i < WHIT_STAGES; ++i) {
        bool known = stats->stages[i].rays > 0 && stats->stages[i].ms >= 0.0;
        sum += known ? stats->stages[i].ms : 0.0;
        timed = timed || known;
    }
    return timed ? sum : -1.0;
}

static json_t *frame_json(const struct engine_frame *frame)
{
    char words[4096], builder[SETTING_VALUE_BYTES];
    json_t *object = json_object();
    builder_write(&frame->accel.params, builder, sizeof builder);
    settings_write(&frame->settings, SETTINGS_STATE, " ", words, sizeof words);
    size_t pixels = (size_t)frame->width * frame->height;
    put_count(object, "number", frame->number);
    put_count(object, "first", frame->first);
    put_count(object, "width", frame->width);
    put_count(object, "height", frame->height);
    put_count(object, "divisor", frame->divisor);
    put_count(object, "samples", frame->samples);
    put_bool(object, "whole", frame->whole);
    put_count(object, "estimates", frame->estimate_count);
    if (frame->estimate_count > 0) {
        const struct engine_estimate *last = &frame->estimates[frame->estimate_count - 1];
        put_number(object, "error", last->error);
        put_count(object, "error_samples", last->samples);
    }
    put_text(object, "drawn_words", words);
    put_text(object, "view", value_word(values_view, (int)frame->settings.paint));
    put_text(object, "builder", builder);
    put_count(object, "made", frame->made);
    put_count(object, "kernels", frame->kernels);
    put_number(object, "render_ms", frame->stats.render_ms);
    put_number(object, "stages_ms", stages_ms(&frame->stats));
    put_number(object, "visits", frame->visits);
    put_count(object, "visits_rays", frame->visits_rays);
    put_hash(object, "ids", hash_of(frame->ids ? whit_image_words(frame->ids) : NULL, pixels * 8));
    put_hash(object, "pixels", hash_of(frame->rgba, pixels * 4));
    return object;
}

static json_t *change_json(const struct engine_change *change)
{
    json_t *object = json_object();
    put_count(object, "number", change->number);
    put_text(object, "what", change->what);
    put_number(object, "before_ms", change->before_ms);
    put_number(object, "after_ms", change->after_ms);
    put_count(object, "pairs", change->ms.count);
    put_number(object, "low_ms", change->ms.low);
    put_number(object, "high_ms", change->ms.high);
    put_count(object, "pixels", change->difference.pixels);
    put_count(object, "other_ids", change->difference.other_ids);
    put_count(object, "other_colors", change->difference.other_colors);
    put_number(object, "largest", change->difference.largest);
    return object;
}

static json_t *compare_json(const struct view *view)
{
    static const char *const modes[] = {"off", "split", "difference"};
    const struct compare *compare = &view->compare;
    const struct compare_figures *figures = &compare->figures;
    const struct compare_heat *heat = &compare->heat;
    json_t *object = json_object();
    put_text(object, "mode", modes[compare->mode]);
    if (compare->mode == COMPARE_OFF)
        return object;
    put_number(object, "divider", compare->divider);
    json_object_set_new(object, "b", frame_json(&compare->other));
    put_bool(object, "known", figures->known);
    if (compare->mode == COMPARE_DIFFERENCE) {
        put_number(object, "scale", heat->scale);
        put_hash(object, "heat", hash_of(heat->rgba, (size_t)heat->width * heat->height * 4));
    } else {
        put_hash(object, "mixed",
                 hash_of(compare->mixed, (size_t)compare->mixed_width * compare->mixed_height * 4));
    }
    if (!figures->known)
        return object;
    put_number(object, "a_ms", figures->ms[0]);
    put_number(object, "b_ms", figures->ms[1]);
    put_count(object, "count", figures->difference.pixels);
    put_count(object, "other_ids", figures->difference.other_ids);
    put_count(object, "other_colors", figures->difference.other_colors);
    put_number(object, "largest", figures->difference.largest);
    put_number(object, "mean", figures->difference.mean);
    put_bool(object, "has_flip", figures->has_flip);
    put_number(object, "flip", figures->flip_mean);
    return object;
}

/* Positions of items to click, by label. */
static json_t *items_json(void)
{
    json_t *object = json_object();
    const char *label;
    float x, y;
    for (uint32_t i = 0; ui_item(i, &label, &x, &y); ++i) {
        char text[48];
        snprintf(text, sizeof text, "%.0f %.0f", (double)x, (double)y);
        put_text(object, label, text);
    }
    return object;
}

/* Positions of panels, by title: of all, or only of those that are partly cut off. */
static json_t *panels_json(bool all)
{
    json_t *object = json_object();
    const char *title;
    float at[4];
    bool cut;
    for (uint32_t i = 0; ui_panel(i, &title, at, &cut); ++i) {
        char text[96];
        snprintf(text, sizeof text, "%.0f %.0f %.0f %.0f", (double)at[0], (double)at[1],
                 (double)at[2], (double)at[3]);
        if (all || cut)
            put_text(object, title, text);
    }
    return object;
}

/* Numbers of pixels that switching an effect changes: of switches that the user made, or
   (`measured`) of those measured in the background. */
static json_t *prices_json(const struct view *view, bool measured)
{
    json_t *object = json_object();
    for (uint32_t i = 0; i < EFFECTS_MAX && whit_effect_name(i); ++i) {
        struct effect_price price = {0};
        if (!measured)
            price = view->panels.prices[i];
        else if (view->panels.measured)
            prices_get_effect(view->panels.measured, i, &price);
        if (price.known)
            put_count(object, whit_effect_name(i), price.other_colors);
    }
    return object;
}

static json_t *keys_json(const struct view *view)
{
    uint32_t count;
    const struct key_binding *keys = key_bindings(&count);
    json_t *object = json_object();
    for (uint32_t i = 0; i < count; ++i) {
        char state[SETTING_TEXT_BYTES] = "";
        if (key_state(view, &keys[i], state, sizeof state))
            put_text(object, keys[i].name, state);
    }
    return object;
}

/* Writes "FILE:LINE: x = VALUE; ...", the first value of each dbg(x); "" if there is none. */
static void calls_text(const whit_probe_report *r, char *text, size_t bytes)
{
    char value[4 * 24];
    text[0] = '\0';
    for (uint32_t i = 0; i < r->call_count; ++i) {
        const whit_probe_call *call = &r->calls[i];
        snprintf(value, sizeof value, "not reached");
        if (call->value_count)
            whit_probe_value_text(&call->values[0], 9, value, sizeof value);
        text_add(text, bytes, "%s%s:%u: %s = %s", i ? "; " : "", path_name(call->file), call->line,
                 call->text, value);
    }
}

static json_t *probe_json(const struct engine_probe *probe)
{
    json_t *object = json_object();
    const whit_probe_report *r = probe->report;
    put_count(object, "number", probe->number);
    if (!r || r->ray_count == 0)
        return object;
    put_count(object, "x", r->x);
    put_count(object, "y", r->y);
    put_count(object, "rays", r->ray_count);
    put_count(object, "differing", r->differing);
    put_count(object, "instance", r->rays[0].device.instance);
    put_count(object, "primitive", r->rays[0].device.primitive);
    put_number(object, "t", r->rays[0].device.t);
    char calls[2048];
    calls_text(r, calls, sizeof calls);
    put_text(object, "dbg", calls);
    return object;
}

/* Makes {"count":3,"median":..,"p95":..,"max":..}. */
static json_t *figures_json(struct view_figures *figures)
{
    json_t *object = json_object();
    put_count(object, "count", figures->count);
    put_number(object, "median", figures_quantile(figures, 0.5));
    put_number(object, "p95", figures_quantile(figures, 0.95));
    put_number(object, "max", figures_quantile(figures, 1.0));
    return object;
}

static json_t *measure_json(struct view_measure *measure)
{
    json_t *object = json_object();
    double now_ms = clock_ms();
    put_number(object, "clock_ms", now_ms);
    put_number(object, "first_ms", measure->first_ms);
    put_number(object, "ms", now_ms - measure->start_ms);
    put_number(object, "cpu_ms", clock_cpu_ms() - measure->cpu_ms);
    put_count(object, "drawn", measure->drawn);
    uint32_t slow = 0;
    for (uint32_t i = 0; i < measure->gap.count && i < FIGURES_MAX; ++i)
        slow += measure->gap.values[i] > 100.0;
    put_count(object, "gaps_over_100_ms", slow);
    json_object_set_new(object, "whole_ms", figures_json(&measure->whole));
    json_object_set_new(object, "quick_ms", figures_json(&measure->quick));
    json_object_set_new(object, "divisor", figures_json(&measure->size));
    json_object_set_new(object, "gap_ms", figures_json(&measure->gap));
    json_object_set_new(object, "between_ms", figures_json(&measure->between));
    json_object_set_new(object, "latency_ms", figures_json(&measure->latency));
    json_object_set_new(object, "present_ms", figures_json(&measure->present));
    return object;
}

static json_t *price_list_json(const struct view *view)
{
    json_t *object = json_object(), *best = json_array();
    struct prices_state state = {0};
    uint64_t broken = 0;
    if (view->prices)
        prices_get_state(view->prices, &state);
    for (uint32_t i = 0; state.report && i < state.report->row_count; ++i) {
        const struct cost_row *row = &state.report->rows[i];
        char name[COST_NAME];
        broken += row->broken;
        price_strip_name(state.strip, state.report, row, name);
        if (row->best && cost_is_judged(state.report, row))
            json_array_append_new(best, json_string(name));
    }
    put_bool(object, "open", view->prices_open);
    put_bool(object, "finished", state.finished);
    put_count(object, "rows", state.report ? state.report->row_count : 0);
    put_count(object, "broken", broken);
    json_object_set_new(object, "best", best);
    put_text(object, "why", state.finished && !state.report ? state.what : "");
    return object;
}

static json_t *wish_json(const struct view *view)
{
    const struct wish *wish = &view->wish;
    json_t *object = json_object();
    put_text(object, "stage", wish_stage_name(wish->stage));
    put_text(object, "text", wish->text);
    put_number(object, "predicted_ms", wish->predicted_ms);
    put_number(object, "predicted_error", wish->predicted_error);
    put_number(object, "took_ms", wish->took_ms);
    put_bool(object, "known", wish->known);
    return object;
}

static json_t *memory_json(void)
{
    uint64_t all, own;
    json_t *object = json_object();
    platform_memory_bytes(&all, &own);
    put_count(object, "all", all / 1024);
    put_count(object, "own", own / 1024);
    return object;
}

/* The whole state; the caller calls json_decref. */
static json_t *state_json(struct view *view, const char *name)
{
    char words[4096], line[VIEW_LINE], quality[HUD_QUALITY_BYTES];
    struct swapchain_info chain;
    json_t *root = json_object();
    put_text(root, "at", name);
    settings_write(&view->settings, SETTINGS_STATE, " ", words, sizeof words);
    view_line(view, line);
    swapchain_get_info(view->swapchain, &chain);
    put_text(root, "scene", view->settings.scene);
    put_text(root, "words", words);
    put_text(root, "render", line);
    put_number(root, "time_s", view->settings.picture.time_s);
    put_count(root, "window_width", chain.width);
    put_count(root, "window_height", chain.height);
    put_number(root, "ui_scale", (double)ui_scale(view->ui));
    put_text(root, "hud", hud_names[view->hud]);
    hud_quality(view, quality);
    put_text(root, "quality", quality);
    put_bool(root, "help", view->help);
    put_bool(root, "playing", view->clock.playing);
    put_text(root, "toast", view->toast);
    put_text(root, "error", view_error(view));
    put_count(root, "errors_drawn", view->shaders.errors_drawn);
    put_text(root, "question", scenes_question(view));
    put_text(root, "work", session_stage_name(view->status.stage));
    put_number(root, "part", (double)view->status.part);
    put_count(root, "shown", view->shown);
    put_number(root, "now_ms", view_now_ms(view));
    json_object_set_new(root, "memory_kb", memory_json());
    json_object_set_new(root, "keys", keys_json(view));
    json_object_set_new(root, "frame", frame_json(&view->frame));
    json_object_set_new(root, "shader", shader_json(&view->shaders));
    put_bool(root, "picked", view->picked);
    json_object_set_new(root, "probe", probe_json(&view->probe));
    put_number(root, "fps_goal", view->settings.fps_goal);
    json_object_set_new(root, "compare", compare_json(view));
    json_object_set_new(root, "items", items_json());
    json_object_set_new(root, "panels", panels_json(true));
    json_object_set_new(root, "cut_panels", panels_json(false));
    json_object_set_new(root, "prices", prices_json(view, false));
    json_object_set_new(root, "effect_prices", prices_json(view, true));
    json_object_set_new(root, "price_list", price_list_json(view));
    json_object_set_new(root, "wish", wish_json(view));
    json_object_set_new(root, "change", change_json(&view->status.change));
    json_object_set_new(root, "measure", measure_json(&view->measure));
    return root;
}

/* Finds a field by its path, names with dots between; borrowed. NULL: there is none. */
static const json_t *find_field(const json_t *object, const char *path, size_t length)
{
    while (object && length > 0) {
        const char *dot = memchr(path, '.', length);
        size_t part = dot ? (size_t)(dot - path) : length;
        char name[64];
        snprintf(name, sizeof name, "%.*s", (int)part, path);
        object = json_object_get(object, name);
        path += part + (dot != NULL);
        length -= part + (dot != NULL);
    }
    return object;
}

/* The part of the state that has the field of a condition. The shader's fields come without hashes
   of pictures, as waiting for them is part of measurements. */
static json_t *condition_json(struct view *view, const char *condition)
{
    if (strncmp(condition, "shader.", 7) != 0)
        return state_json(view, "");
    json_t *root = json_object();
    json_object_set_new(root, "shader", shader_json(&view->shaders));
    return root;
}

/* Whether a value is missing, empty, null, false or 0. */
static bool is_nothing(const json_t *value)
{
    return !value || json_is_null(value) || json_is_false(value) ||
           (json_is_string(value) && json_string_length(value) == 0) ||
           (json_is_number(value) && json_number_value(value) == 0.0) ||
           (json_is_object(value) && json_object_size(value) == 0) ||
           (json_is_array(value) && json_array_size(value) == 0);
}

bool state_has(struct view *view, const char *condition)
{
    const char *equals = strstr(condition, " ="), *value = equals ? equals + 2 : "";
    json_t *root = condition_json(view, condition);
    const json_t *field =
        find_field(root, condition, equals ? (size_t)(equals - condition) : strlen(condition));
    char *dumped = json_dumps(field, JSON_ENCODE_ANY);
    const char *text = json_is_string(field) ? json_string_value(field) : dumped ? dumped : "";
    bool has = equals ? strcmp(text, value + (*value == ' ')) == 0 : !is_nothing(field);
    free(dumped);
    json_decref(root);
    return has;
}

void state_print(struct view *view, const char *name, FILE *to)
{
    json_t *root = state_json(view, name);
    char *text = json_dumps(root, JSON_COMPACT), shown[WHIT_SHOWN_BYTES];
    size_t length;
    for (const char *at = text; at && (length = whit_text_next(at, shown)) != 0; at += length)
        fputs(shown, to);
    fputc('\n', to);
    free(text);
    fflush(to);
    json_decref(root);
    measure_begin(view);
}

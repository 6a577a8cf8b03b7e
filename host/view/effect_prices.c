#include "view/effect_prices.h"

#include <stdio.h>
#include <string.h>

enum { PIXELS_MAX = 128 * 96, ROUNDS = 9 };

/* ---- Switches in words ---- */

/* `text` without what it says of `name`. */
static void leave_out(const char *text, const char *name, char *out, size_t bytes)
{
    size_t used = 0;
    out[0] = '\0';
    while (text && *text) {
        size_t length = strcspn(text, ",");
        bool its_own = (text[0] == '+' || text[0] == '-') && strlen(name) == length - 1 &&
                       strncmp(text + 1, name, length - 1) == 0;
        if (!its_own && used + length + 2 < bytes)
            used += (size_t)snprintf(out + used, bytes - used, "%s%.*s", used ? "," : "",
                                     (int)length, text);
        text += length + (text[length] != 0);
    }
}

bool effect_switch_text(const char *effects, uint32_t index, bool called, bool on,
                        char out[SETTING_TEXT_BYTES])
{
    const char *name = whit_effect_name(index);
    char text[SETTING_TEXT_BYTES], next[SETTING_TEXT_BYTES + 64];
    leave_out(effects, name, text, sizeof text);
    bool all = strncmp(text, "all", 3) == 0, base = all || called;
    bool more = base != on; /* only what is other than the base, auto or all, gives, is said */
    snprintf(next, sizeof next, "%s%s%s%s", text, more && text[0] ? "," : "",
             more ? (on ? "+" : "-") : "", more ? name : "");
    if (strcmp(next, "auto") == 0)
        next[0] = '\0';
    if (strlen(next) >= SETTING_TEXT_BYTES)
        return false;
    memcpy(out, next, strlen(next) + 1);
    return true;
}

/* ---- Prices ---- */

/* The settings' picture, as much smaller as its time wants it. */
static whit_renderer_params small_picture(const struct effect_work *work)
{
    whit_renderer_params params = settings_picture(work->settings);
    uint32_t width = params.width, height = params.height;
    for (uint32_t by = 2; (uint64_t)params.width * params.height > PIXELS_MAX; ++by) {
        params.width = (width + by - 1) / by;
        params.height = (height + by - 1) / by;
    }
    params.samples = 1;
    params.adaptive = 0.0;
    params.count = false;
    params.cancel = work->cancel;
    return params;
}

static whit_result price_effect(const struct effect_work *work, whit_renderer *usual,
                                uint32_t index, struct effect_price *price)
{
    whit_effect_info info;
    char effects[SETTING_TEXT_BYTES];
    struct cost_price cost;
    whit_difference difference;
    whit_renderer *other = NULL;
    whit_renderer_params params = small_picture(work);
    enum cost_clock clock = cost_clock_of(work->device, usual);
    whit_scene_get_effect(work->scene, index, &info);
    if (!effect_switch_text(work->settings->effects, index, info.called, false, effects))
        return WHIT_ERROR_USAGE;
    params.effects = effects[0] ? effects : NULL;
    whit_result result = whit_renderer_create(work->device, work->accel, &params, &other);
    if (result == WHIT_OK)
        result = cost_price(usual, NULL, other, NULL, clock, ROUNDS, &cost);
    if (result == WHIT_OK)
        result = cost_colors(usual, other, work->log, &difference);
    if (result == WHIT_OK) {
        price->other_colors = difference.differing_pixels;
        price->pixels = difference.pixel_count;
        price->known = true;
        price->before_ms = cost.usual_ms[clock].median;
        price->after_ms = cost.setting_ms[clock].median;
        price->verdict = cost.verdict;
    }
    whit_renderer_destroy(other);
    return result;
}

/* Those that are in the kernel: each needs another one, and what is not called for changes nothing.
 */
static whit_result price_all(const struct effect_work *work, whit_renderer *usual)
{
    whit_result result = WHIT_OK;
    for (uint32_t i = 0; i < EFFECTS_MAX && whit_effect_name(i) && result == WHIT_OK; ++i) {
        struct effect_price price = {0};
        if (!whit_renderer_compiles(usual, i) || !whit_effect_can_remove(i))
            continue;
        work->say(work->user, (double)i / EFFECTS_MAX, whit_effect_name(i));
        result = *work->cancel ? WHIT_ERROR_CANCELLED : price_effect(work, usual, i, &price);
        if (result == WHIT_OK)
            work->found(work->user, i, &price);
    }
    return result;
}

whit_result effect_prices_measure(const struct effect_work *work)
{
    whit_renderer *usual = NULL;
    const whit_renderer_params params = small_picture(work);
    whit_result result = whit_renderer_create(work->device, work->accel, &params, &usual);
    if (result == WHIT_OK)
        result = whit_renderer_render(usual);
    if (result == WHIT_OK)
        result = price_all(work, usual);
    whit_renderer_destroy(usual);
    return result;
}

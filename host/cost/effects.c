/* Prices effects: times the usual picture and one with a single effect added or removed, in
   turns. */
#include "cost/cost.h"

static whit_result price_effect(const struct cost_effects *request, uint32_t index,
                                struct cost_effect *effect)
{
    whit_effect_info info;
    whit_renderer *other = NULL;
    whit_renderer_params params = *request->params;
    enum cost_clock clock = cost_clock_of(request->device, request->usual);
    whit_scene_get_effect(request->scene, index, &info);
    effects_set(&params, index, effect->compiled || info.called, !effect->compiled);
    whit_result result = whit_renderer_create(request->device, request->accel, &params, &other);
    if (result == WHIT_OK)
        result = cost_price(request->usual, NULL, other, NULL, NULL, clock, request->rounds,
                            &effect->price);
    if (result == WHIT_OK)
        result = cost_colors(request->usual, other, request->log, &effect->error);
    effect->clock = clock;
    effect->priced = result == WHIT_OK;
    whit_renderer_destroy(other);
    return result;
}

static bool is_priced(const struct cost_effects *request, uint32_t index)
{
    if (whit_renderer_compiles(request->usual, index))
        return whit_effect_can_remove(index);
    return request->added && whit_effect_can_add(index);
}

uint32_t cost_effects_count(const struct cost_effects *request)
{
    uint32_t count = 0;
    for (uint32_t i = 0; whit_effect_name(i); ++i)
        count += is_priced(request, i);
    return count;
}

whit_result cost_effects_measure(const struct cost_effects *request)
{
    whit_result result = WHIT_OK;
    uint32_t count = cost_effects_count(request), done = 0;
    for (uint32_t i = 0; whit_effect_name(i) && result == WHIT_OK; ++i) {
        struct cost_effect effect = {.compiled = whit_renderer_compiles(request->usual, i)};
        if (is_priced(request, i)) {
            result = request->begin(request->user, (double)done++ / count, whit_effect_name(i));
            if (result == WHIT_OK)
                result = price_effect(request, i, &effect);
        }
        if (result == WHIT_OK)
            request->found(request->user, i, &effect);
    }
    return result;
}

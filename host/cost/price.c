#include "cost/price.h"
#include "whit/whit_program.h"

#include <string.h>

const char *cost_clock_name(enum cost_clock clock)
{
    static const char *const names[] = {"wall", "cpu", "device"};
    return names[clock];
}

enum cost_clock cost_clock_of(const whit_device *device, const whit_renderer *renderer)
{
    whit_device_info info;
    whit_stats stats;
    whit_device_get_info(device, &info);
    whit_renderer_get_stats(renderer, &stats);
    if (info.kind == WHIT_DEVICE_CPU)
        return COST_CPU; /* other programs disturb it less than the wall clock */
    return stats.render_device_ms >= 0.0 ? COST_DEVICE : COST_WALL;
}

struct pricing {
    whit_renderer *renderers[2];
    whit_reference *reference; /* in place of the second, or NULL */
    double ms[COST_CLOCKS][2][COST_ROUNDS_MAX];
    bool has_device;
};

static whit_result draw(const struct pricing *pricing, uint32_t way)
{
    whit_image *image = NULL;
    if (way == 0 || !pricing->reference)
        return whit_renderer_render(pricing->renderers[way]);
    whit_result result = whit_reference_render(pricing->reference, &image, NULL);
    whit_image_destroy(image);
    return result;
}

static whit_result run_once(void *user, uint32_t way, uint32_t round)
{
    struct pricing *pricing = user;
    whit_stats stats;
    double cpu_ms = whit_clock_cpu_ms(), wall_ms = whit_clock_ms();
    whit_result result = draw(pricing, way);
    pricing->ms[COST_WALL][way][round] = whit_clock_ms() - wall_ms;
    pricing->ms[COST_CPU][way][round] = whit_clock_cpu_ms() - cpu_ms;
    if (way == 1 && pricing->reference)
        stats.render_device_ms = pricing->ms[COST_WALL][way][round];
    else
        whit_renderer_get_stats(pricing->renderers[way], &stats);
    pricing->ms[COST_DEVICE][way][round] = stats.render_device_ms;
    pricing->has_device = pricing->has_device && stats.render_device_ms >= 0.0;
    return result;
}

static struct sample_median median_of(const double *values, uint32_t count)
{
    double copy[COST_ROUNDS_MAX];
    memcpy(copy, values, count * sizeof *copy);
    return sample_median_of(copy, count);
}

static void conclude(const struct pricing *pricing, enum cost_clock clock, uint32_t rounds,
                     struct cost_price *out)
{
    double values[COST_ROUNDS_MAX];
    for (uint32_t c = 0; c < COST_CLOCKS; ++c) {
        const double *usual = pricing->ms[c][0], *setting = pricing->ms[c][1];
        if (c == COST_DEVICE && !pricing->has_device)
            continue;
        out->usual_ms[c] = median_of(usual, rounds);
        out->setting_ms[c] = median_of(setting, rounds);
        int verdict = sample_compare(setting, usual, rounds, values, &out->difference[c]);
        if (c == (uint32_t)clock)
            out->verdict = verdict;
        for (uint32_t i = 0; i < rounds; ++i)
            values[i] = setting[i] / (usual[i] > 0.0 ? usual[i] : 1e-6);
        out->ratio[c] = sample_median_of(values, rounds);
    }
}

/* Lets both warm up once, then times them in turns. */
static whit_result price(struct pricing *pricing, enum cost_clock clock, uint32_t rounds,
                         struct cost_price *out)
{
    whit_result result = WHIT_OK;
    for (uint32_t way = 0; result == WHIT_OK && way < 2; ++way)
        result = run_once(pricing, way, 0);
    if (result == WHIT_OK)
        result = sample_in_turns(2, rounds, run_once, pricing);
    if (result == WHIT_OK)
        conclude(pricing, clock, rounds, out);
    return result;
}

whit_result cost_price(whit_renderer *usual, const whit_renderer_params *first,
                       whit_renderer *setting, const whit_renderer_params *second,
                       whit_reference *reference, enum cost_clock clock, uint32_t rounds,
                       struct cost_price *out)
{
    struct pricing pricing = {
        .renderers = {usual, setting}, .reference = reference, .has_device = true};
    whit_result result = WHIT_OK;
    rounds = rounds < COST_ROUNDS_MAX ? rounds : COST_ROUNDS_MAX;
    *out = (struct cost_price){.rounds = rounds};
    if (first)
        result = whit_renderer_set_view(usual, first);
    if (result == WHIT_OK && second && !reference)
        result = whit_renderer_set_view(setting, second);
    if (result == WHIT_OK)
        result = price(&pricing, clock, rounds, out);
    if (second) {
        out->width = second->width;
        out->height = second->height;
    }
    return result;
}

whit_result cost_time(whit_renderer *renderer, const whit_renderer_params *view, uint32_t rounds,
                      struct cost_times *out)
{
    struct pricing pricing = {.renderers = {renderer}, .has_device = true};
    rounds = rounds < COST_ROUNDS_MAX ? rounds : COST_ROUNDS_MAX;
    *out = (struct cost_times){0};
    whit_result result = whit_renderer_set_view(renderer, view);
    if (result == WHIT_OK)
        result = run_once(&pricing, 0, 0); /* warms up */
    if (result == WHIT_OK)
        result = sample_in_turns(1, rounds, run_once, &pricing);
    if (result != WHIT_OK)
        return result;
    for (uint32_t c = 0; c < COST_CLOCKS; ++c)
        if (c != COST_DEVICE || pricing.has_device)
            out->ms[c] = median_of(pricing.ms[c][0], rounds);
    sample_sort(pricing.ms[COST_WALL][0], rounds);
    out->wall_max_ms = sample_quantile(pricing.ms[COST_WALL][0], rounds, 0.9);
    return WHIT_OK;
}

whit_result cost_colors(whit_renderer *a, whit_renderer *b, const whit_log *log,
                        whit_difference *out)
{
    const whit_compare_params params = {.no_flip = true};
    whit_image *x = NULL, *y = NULL;
    whit_result result = whit_renderer_image(a, WHIT_AOV_COLOR, &x);
    if (result == WHIT_OK)
        result = whit_renderer_image(b, WHIT_AOV_COLOR, &y);
    if (result == WHIT_OK)
        result = whit_image_compare(x, y, &params, log, out, NULL);
    whit_image_destroy(x);
    whit_image_destroy(y);
    return result;
}

/* Sums the statistics of several pictures. */
#include <math.h>
#include <string.h>

#include "api/handles.h"
#include "twin/counters.h"

static void add_stage(const whit_stage *from, whit_stage *to)
{
    bool measured = from->ms >= 0.0 && to->ms >= 0.0;
    memcpy(to->name, from->name, sizeof to->name);
    to->rays += from->rays;
    to->ms = measured ? to->ms + from->ms : -1.0;
}

void api_set_rate(whit_stats *stats)
{
    double rays = (double)(whit_stats_rays(stats) + stats->rays_of_estimate);
    stats->mrays_per_s = stats->render_ms > 0.0 ? rays / stats->render_ms * 1e-3 : 0.0;
}

void whit_stats_add(const whit_stats *from, whit_stats *to)
{
    to->render_ms += from->render_ms;
    bool measured = from->render_device_ms >= 0.0 && to->render_device_ms >= 0.0;
    to->render_device_ms = measured ? to->render_device_ms + from->render_device_ms : -1.0;
    to->rays_primary += from->rays_primary;
    to->rays_shadow += from->rays_shadow;
    to->rays_reflected += from->rays_reflected;
    to->rays_refracted += from->rays_refracted;
    to->rays_straight += from->rays_straight;
    to->rays_by_functions += from->rays_by_functions;
    to->rays_of_estimate += from->rays_of_estimate;
    to->rays_cut_depth += from->rays_cut_depth;
    to->rays_cut_bailout += from->rays_cut_bailout;
    to->weight_cut_depth = fmax(to->weight_cut_depth, from->weight_cut_depth);
    to->weight_cut_bailout = fmax(to->weight_cut_bailout, from->weight_cut_bailout);
    bool bounded = from->bailout_bound >= 0.0 && to->bailout_bound >= 0.0;
    to->bailout_bound = bounded ? fmax(to->bailout_bound, from->bailout_bound) : -1.0;
    for (int i = 0; i < WHIT_SAMPLE_LEVELS; ++i)
        to->pixels_by_samples[i] += from->pixels_by_samples[i];
    to->dispatches += from->dispatches;
    to->tiles += from->tiles;
    to->deferred += from->deferred;
    to->tile_size = from->tile_size;
    to->device_bytes = from->device_bytes;
    for (int kind = 0; kind < WHIT_RAY_KINDS; ++kind)
        cost_merge(&to->costs[kind], &from->costs[kind]);
    for (int i = 0; i < WHIT_STAGES; ++i)
        add_stage(&from->stages[i], &to->stages[i]);
    api_set_rate(to);
}

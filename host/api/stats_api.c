/* Sums the statistics of several pictures. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "api/handles.h"
#include "twin/counters.h"

static double timed_rays(const whit_stage *stage)
{
    return stage->ms >= 0.0 ? (double)stage->rays : 0.0;
}

/* The rays of a picture in which none was timed take as long as those of the other. */
static void add_stage(const whit_stage *from, whit_stage *to)
{
    double timed = timed_rays(from) + timed_rays(to);
    double ms = fmax(from->ms, 0.0) + fmax(to->ms, 0.0);
    memcpy(to->name, from->name, sizeof to->name);
    to->rays += from->rays;
    to->ms = timed > 0.0 ? ms * (double)to->rays / timed : -1.0;
}

static int compare_shares(const void *a, const void *b)
{
    double left = ((const whit_share *)a)->share, right = ((const whit_share *)b)->share;
    return (left < right) - (left > right);
}

/* Shares of both pictures, weighted by the rays of their stages, which are not added up yet. */
static void add_shares(const whit_stats *from, whit_stats *to)
{
    whit_share all[2 * WHIT_SHARES];
    uint32_t count = 0;
    for (int side = 0; side < 2; ++side) {
        const whit_stats *one = side == 0 ? to : from;
        for (uint32_t i = 0; i < one->share_count; ++i) {
            whit_share share = one->shares[i];
            double timed =
                timed_rays(&to->stages[share.stage]) + timed_rays(&from->stages[share.stage]);
            share.share *= timed_rays(&one->stages[share.stage]) / fmax(timed, 1.0);
            uint32_t k = 0;
            while (k < count && (all[k].stage != share.stage || all[k].material != share.material))
                ++k;
            if (k < count)
                all[k].share += share.share;
            else
                all[count++] = share;
        }
    }
    qsort(all, count, sizeof *all, compare_shares);
    to->share_count = count < WHIT_SHARES ? count : WHIT_SHARES;
    memcpy(to->shares, all, to->share_count * sizeof *all);
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
    add_shares(from, to);
    for (int i = 0; i < WHIT_STAGES; ++i)
        add_stage(&from->stages[i], &to->stages[i]);
    api_set_rate(to);
}

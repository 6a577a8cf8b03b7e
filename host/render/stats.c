/* The statistics of a picture. */
#include <string.h>

#include "render/material_shares.h"
#include "render/renderer.h"
#include "render/stage_times.h"

void stats_clear(struct target *target)
{
    const whit_stats before = target->stats;
    target->stats = (whit_stats){.upload_ms = before.upload_ms,
                                 .compile_ms = before.compile_ms,
                                 .device_bytes = before.device_bytes,
                                 .kernel_instructions = before.kernel_instructions,
                                 .kernels_beside = before.kernels_beside,
                                 .general = before.general,
                                 .load_path = before.load_path};
    memset(target->timed, 0, sizeof target->timed);
}

void renderer_get_stats(const struct renderer *renderer, whit_stats *stats)
{
    *stats = renderer->picture.stats;
    stats->packets = renderer->packets && renderer->packet_stack_size <= PACKET_STACK_MAX;
    stage_times_scale(renderer, stats);
    stats->rays_straight =
        stats->stages[RENDER_STAGE_CLOSEST].rays - stats->rays_reflected - stats->rays_refracted;
    material_shares_get(&renderer->picture, stats);
    stats->bailout_bound =
        renderer->rendered ? bailout_bound(renderer, stats->weight_cut_bailout) : -1.0;
    if (stats->render_ms > 0.0)
        stats->mrays_per_s = (double)whit_stats_rays(stats) / stats->render_ms * 1e-3;
}

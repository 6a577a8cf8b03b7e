/* The statistics of a picture. */
#include "render/renderer.h"

void stats_clear(struct render_stats *stats)
{
    *stats = (struct render_stats){.upload_ms = stats->upload_ms,
                                   .compile_ms = stats->compile_ms,
                                   .device_bytes = stats->device_bytes,
                                   .kernel_instructions = stats->kernel_instructions,
                                   .largest_instructions = stats->largest_instructions,
                                   .general = stats->general,
                                   .texel_loads = stats->texel_loads};
}

void renderer_get_stats(const struct renderer *renderer, struct render_stats *stats)
{
    *stats = renderer->picture.stats;
    stats->packets = renderer->packets && renderer->packet_stack_size <= PACKET_STACK_MAX;
    stage_times_scale(renderer, stats);
    material_shares_get(&renderer->picture, stats);
    stats->bailout_bound = renderer->rendered ? bailout_bound(renderer) : -1.0;
}

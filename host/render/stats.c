/* The statistics of a picture. */
#include "render/renderer.h"

#include <math.h>

static void add_count(struct render_stats *stats, const struct gpu_counts *count)
{
    stats->rays_shadow += count->shadow;
    stats->rays_reflected += count->reflected;
    stats->rays_refracted += count->refracted;
    stats->rays_cut_depth += count->cut_depth;
    stats->rays_cut_bailout += count->cut_bailout;
    stats->weight_cut_depth = fmax(stats->weight_cut_depth, (double)count->cut_depth_weight);
    stats->weight_cut_bailout = fmax(stats->weight_cut_bailout, (double)count->cut_bailout_weight);
}

whit_result stats_add_counts(struct renderer *renderer, const struct progress *progress,
                             size_t first, size_t count)
{
    struct gpu_counts counts[READ_SLICE];
    for (size_t at = 0; at < count; at += READ_SLICE) {
        size_t n = count - at < READ_SLICE ? count - at : READ_SLICE;
        whit_result result = buffer_read(renderer->pixel_buffers.counts, at * sizeof *counts,
                                         counts, n * sizeof *counts);
        if (result != WHIT_OK)
            return result;
        for (size_t i = 0; i < n; ++i) {
            if (adaptive_draws(progress, first + at + i))
                add_count(&renderer->stats, &counts[i]);
        }
    }
    return WHIT_OK;
}

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
    *stats = renderer->stats;
    stats->packets = renderer->packets && renderer->packet_stack_size <= PACKET_STACK_MOST;
    stage_times_scale(renderer, stats);
    stats->bailout_bound = renderer->rendered ? bailout_bound(renderer) : -1.0;
}

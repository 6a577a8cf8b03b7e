/* Costs of traversals: the kernel's counts of each chunk, summed up; those of a pixel's first
   sample are kept as images. */
#include <string.h>

#include "device/buffer.h"
#include "render/costs.h"
#include "render/tiles.h"

enum { COST_WORDS = sizeof(struct gpu_cost) / sizeof(uint32_t) };

void costs_clear(struct renderer *renderer)
{
    for (uint32_t kind = 0; kind < RAY_KIND_COUNT; ++kind)
        image_finish(&renderer->costs[kind]);
}

/* A kind of rays that does not occur in the picture gets no image. */
static whit_result keep(struct renderer *renderer, uint32_t kind, uint32_t x, uint32_t y,
                        const struct gpu_cost *cost)
{
    struct image *image = &renderer->costs[kind];
    if (!image->words) {
        whit_result result = image_init_logged(&renderer->log, image, renderer->params.width,
                                               renderer->params.height, COST_WORDS, true);
        if (result != WHIT_OK)
            return result;
    }
    memcpy(&image->words[((size_t)y * image->width + x) * COST_WORDS], cost, sizeof *cost);
    return WHIT_OK;
}

whit_result costs_add(struct target *target, const struct gpu_chunk *chunk)
{
    struct renderer *renderer = target->renderer;
    struct gpu_cost costs[RENDER_BLOCK_PIXELS][RAY_KIND_COUNT];
    const whit_renderer_params *params = &renderer->params;
    whit_result result = WHIT_OK;
    for (uint32_t b = 0; params->count && result == WHIT_OK && b < chunk->block_count; ++b) {
        uint32_t block = chunk->first_block + b;
        result = buffer_read(target->buffers.costs, b * sizeof costs, costs, sizeof costs);
        for (uint32_t i = 0; result == WHIT_OK && i < RENDER_BLOCK_PIXELS; ++i) {
            uint32_t x, y;
            bool inside = render_slot_pixel(renderer, block, i, &x, &y);
            for (uint32_t k = 0; inside && k < RAY_KIND_COUNT; ++k) {
                cost_add(&target->stats.costs[k], &costs[i][k]);
                if (result == WHIT_OK && chunk->sample_index == 0 && costs[i][k].rays > 0)
                    result = keep(renderer, k, x, y, &costs[i][k]);
            }
        }
    }
    return result;
}

whit_result renderer_read_costs(struct renderer *renderer, uint32_t kind, struct image *out)
{
    const whit_renderer_params *params = &renderer->params;
    if (!renderer->rendered || !params->count || kind >= RAY_KIND_COUNT)
        return log_usage(&renderer->log, "%s",
                         !params->count ? "costs were not asked for when the renderer was made"
                         : !renderer->rendered ? RENDER_NO_PICTURE
                                               : "there is no such kind of rays");
    whit_result result =
        image_init_logged(&renderer->log, out, params->width, params->height, COST_WORDS, true);
    size_t words = (size_t)params->width * params->height * COST_WORDS;
    if (result == WHIT_OK && renderer->costs[kind].words)
        memcpy(out->words, renderer->costs[kind].words, words * sizeof *out->words);
    return result;
}

/* What post() of a user's file makes of a picture that is there already, without tracing its rays
   once more: the pixels as they are without it stay on the device. */
#include <string.h>

#include "render/renderer.h"

enum { BLOCKS_AT_ONCE = 4096 }; /* below the 2^14 that slot_pixel() of the kernels divides right */

static void describe(const struct renderer *renderer, struct before_post *of)
{
    const whit_renderer_params *params = &renderer->params;
    memset(of, 0, sizeof *of); /* it is compared by its bytes */
    of->known = true;
    of->frame = renderer->frame;
    memcpy(of->sliders, renderer->sliders, sizeof of->sliders);
    of->samples = params->sampling.count;
    of->first_sample = params->sampling.first;
    of->time_s = params->time_s;
    of->first_row = params->first_row;
    of->rows = params_rows(params);
}

void post_keep(struct renderer *renderer)
{
    if (renderer->picture.stages.set.passes[STAGE_POST].pipeline && readback_is_late(renderer) &&
        !renderer->params.count && !renderer->views.count)
        describe(renderer, &renderer->before_post);
}

/* Rays of post() itself are among those of the picture's statistics. */
static bool post_traces(const whit_shader *shader)
{
    return shader->codes[SHADER_KERNEL_POST].reaches != 0;
}

bool post_can_reuse(const struct renderer *renderer)
{
    struct before_post wanted;
    describe(renderer, &wanted);
    return renderer->params.reuse_rays && !renderer->views.count && readback_is_late(renderer) &&
           renderer->picture.stages.set.passes[STAGE_POST].pipeline &&
           !post_traces(renderer->params.shader) &&
           memcmp(&renderer->before_post, &wanted, sizeof wanted) == 0;
}

static void dispatch(struct renderer *renderer, struct gpu_chunk *chunk)
{
    const struct stages *stages = &renderer->picture.stages;
    const struct pass *pass = &stages->set.passes[stages->set.of[STAGE_POST]];
    commands_bind(renderer->commands, pass->pipeline, pass->set);
    commands_push(renderer->commands, chunk, sizeof *chunk);
    commands_dispatch(renderer->commands,
                      (render_groups(chunk) + pass->rays_each - 1) / pass->rays_each, 1, 1);
}

whit_result post_render(struct renderer *renderer)
{
    const struct lattice lattice = lattice_whole(renderer);
    uint32_t across = pixels_blocks_across(lattice.width);
    uint32_t end = pixels_blocks_across(lattice.height) * across;
    struct gpu_chunk chunk = {.first_block = renderer->params.first_row / 8 * across,
                              .blocks_x = across,
                              .lattice = lattice_word(&lattice),
                              .band_y = renderer->params.first_row,
                              .band_rows = lattice.height - renderer->params.first_row,
                              .light = GENERATION_NONE,
                              .list = LIST_RAYS};
    render_take_sample(&renderer->picture, 0, 1, &chunk);
    whit_result result = commands_begin(renderer->commands);
    if (result != WHIT_OK)
        return result;
    commands_fill(renderer->commands, renderer->picture.buffers.status, 0, 4, 0);
    commands_barrier(renderer->commands);
    for (; chunk.first_block < end; chunk.first_block += chunk.block_count) {
        uint32_t left = end - chunk.first_block;
        chunk.block_count = left < BLOCKS_AT_ONCE ? left : BLOCKS_AT_ONCE;
        dispatch(renderer, &chunk);
    }
    return render_finish_submission(&renderer->picture);
}

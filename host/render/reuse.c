/* Draws a picture with the next version of a user's file from the last picture, if only post() or
   aovs have changed: the colours that post() was given are still on the device, and aovs need only
   camera rays. */
#include <string.h>

#include "device/commands.h"
#include "render/hooks.h"
#include "render/pixels.h"
#include "render/readback.h"
#include "render/reuse.h"
#include "render/steps.h"
#include "render/tiles.h"

/* The spacing of the step that is shown first: the window converts and shows a quarter of the
   pixels sooner than all of them. */
enum { STEP_FIRST = 2 };
enum { BLOCKS_AT_ONCE = 4096 }; /* below 2^14, where slot_pixel() of the kernels divides right */

static void describe(const struct renderer *renderer, struct kept_view *of)
{
    const whit_renderer_params *params = &renderer->params;
    memset(of, 0, sizeof *of); /* padding too: it is compared by memcmp */
    of->frame = renderer->frame;
    memcpy(of->sliders, renderer->sliders, sizeof of->sliders);
    of->samples = params->sampling.count;
    of->first_sample = params->sampling.first;
    of->time_s = params->time_s;
    of->first_row = params->first_row;
    of->rows = params_rows(params);
}

/* Whether post() or an aov traces rays, which would have to be counted in the picture's
   statistics. */
static bool functions_trace(const whit_shader *shader)
{
    return ((shader->codes[HOOK_KERNEL_POST].reaches | shader->codes[HOOK_KERNEL_AOV].reaches) &
            SHADER_REACHES_RAYS) != 0;
}

static bool has(const struct renderer *renderer, enum stage stage)
{
    return renderer->picture.stages.set.passes[stage].pipeline != NULL;
}

static bool can_keep(const struct renderer *renderer)
{
    return (has(renderer, STAGE_AOV) || has(renderer, STAGE_POST)) && readback_is_late(renderer) &&
           !renderer->params.count && !renderer->views.count &&
           !functions_trace(renderer->params.shader);
}

void reuse_note(struct renderer *renderer)
{
    const struct target *picture = &renderer->picture;
    struct kept_picture *kept = &renderer->kept;
    kept->known = kept->aovs = can_keep(renderer);
    if (!kept->known)
        return;
    describe(renderer, &kept->view);
    kept->stats = picture->stats;
    memcpy(kept->timed, picture->timed, sizeof kept->timed);
}

static bool keeps_view(const struct renderer *renderer)
{
    struct kept_view wanted;
    describe(renderer, &wanted);
    return renderer->kept.known && can_keep(renderer) &&
           memcmp(&renderer->kept.view, &wanted, sizeof wanted) == 0;
}

bool reuse_is_possible(const struct renderer *renderer)
{
    return renderer->params.reuse_rays && keeps_view(renderer);
}

/* A picture of one sample writes each pixel once, in the same view with the value that the pixel
   has already. */
bool reuse_outlives(const struct renderer *renderer)
{
    return keeps_view(renderer) && renderer->params.sampling.count == 1 &&
           !steps_are_wanted(renderer);
}

static whit_result draw_post(struct renderer *renderer)
{
    const struct stages *stages = &renderer->picture.stages;
    const struct pass *pass = &stages->set.passes[stages->set.of[STAGE_POST]];
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
    commands_bind(renderer->commands, pass->pipeline, pass->set);
    for (; chunk.first_block < end; chunk.first_block += chunk.block_count) {
        uint32_t left = end - chunk.first_block;
        chunk.block_count = left < BLOCKS_AT_ONCE ? left : BLOCKS_AT_ONCE;
        render_push_chunk(renderer, &chunk);
        commands_dispatch(renderer->commands,
                          (render_groups(&chunk) + pass->rays_each - 1) / pass->rays_each, 1, 1);
    }
    return render_finish_submission(&renderer->picture);
}

static whit_result draw_aovs(struct renderer *renderer, bool in_steps)
{
    struct progress progress = render_progress(renderer);
    progress.aovs_alone = true;
    return in_steps ? steps_render(renderer, &progress)
                    : render_pass(renderer, renderer->params.sampling.count, &progress);
}

/* Statistics are those of the kept picture, except for kernels and memory, which are new. */
static void restore_stats(struct renderer *renderer)
{
    struct target *picture = &renderer->picture;
    const whit_stats now = picture->stats;
    picture->stats = renderer->kept.stats;
    picture->stats.compile_ms = now.compile_ms;
    picture->stats.device_bytes = now.device_bytes;
    picture->stats.kernel_instructions = now.kernel_instructions;
    memcpy(picture->timed, renderer->kept.timed, sizeof picture->timed);
}

whit_result reuse_render(struct renderer *renderer)
{
    struct kept_picture *kept = &renderer->kept;
    bool steps = steps_are_wanted(renderer), draws = !kept->aovs;
    bool waits = draws && renderer->params.step_aov;
    whit_result result = WHIT_OK;
    if (has(renderer, STAGE_POST))
        result = draw_post(renderer);
    if (result == WHIT_OK && steps && !waits)
        result = steps_give(renderer, STEP_FIRST);
    if (result == WHIT_OK && draws)
        result = draw_aovs(renderer, steps && waits);
    kept->aovs = result == WHIT_OK || !draws;
    restore_stats(renderer);
    renderer->rendered = result == WHIT_OK;
    return result;
}

/* The time that the stages of a picture take, where it is asked for. Time stamps around each
   dispatch would slow small tiles down on drivers that end a batch of work for each stamp
   (lavapipe). So only some tiles are timed, and the time of an item there stands for all items. */
#include <stdio.h>
#include <stdlib.h>

#include "base/array.h"
#include "device/buffer.h"
#include "device/commands.h"
#include "render/material_shares.h"
#include "render/renderer.h"
#include "render/stage_times.h"
#include "render/stages.h"
#include "render/tiles.h"

/* One tile in TIMED_ONE_IN is timed, by a hash of its number, so that they make no pattern in the
   picture; and always the second. The first never is: drivers that make machine code at the first
   dispatch (lavapipe) do it there. */
enum { TIMED_ONE_IN = 8 };

void stage_times_begin(struct target *target)
{
    struct stage_times *times = &target->stages.times;
    uint32_t tile = times->tiles;
    bool scattered = tile * 0x9e3779b9u < UINT32_MAX / TIMED_ONE_IN;
    bool timed = tile == 1 || (tile > 1 && scattered);
    *times = (struct stage_times){.tiles = tile + 1,
                                  .on = timed && target->renderer->params.time_stages,
                                  .row = RENDER_STAGE_COUNT};
}

void stage_times_submission(struct target *target)
{
    struct stage_times *times = &target->stages.times;
    times->span_count = 0;
    times->row = RENDER_STAGE_COUNT;
}

void stage_times_next(struct target *target, uint32_t row)
{
    struct renderer *renderer = target->renderer;
    struct stage_times *times = &target->stages.times;
    if (!times->on || times->row == row)
        return;
    if (times->span_count + 1 == COMMANDS_SPANS) {
        times->on = false;
        return;
    }
    times->rows[times->span_count++] = times->row;
    times->row = row;
    commands_span_end(renderer->commands);
    commands_span_begin(renderer->commands, "stage");
}

void stage_times_take(struct target *target)
{
    struct stage_times *times = &target->stages.times;
    if (!times->on)
        return;
    times->rows[times->span_count++] = times->row;
    for (uint32_t i = 0; i < times->span_count; ++i) {
        double ms = commands_span_ms(target->renderer->commands, i);
        times->on = times->on && ms >= 0.0;
        if (times->rows[i] < RENDER_STAGE_COUNT)
            times->ms[times->rows[i]] += ms;
    }
}

static void add_items(struct target *target, uint32_t row, uint64_t items)
{
    target->stats.stages[row].rays += items;
    if (target->stages.times.on)
        target->timed[row].items += items;
}

static uint64_t items_of(const struct gpu_generation *generation, uint32_t list)
{
    return (uint64_t)generation->lists[list].front + generation->lists[list].back;
}

bool stage_times_by_light(const struct renderer *renderer)
{
    return renderer->frame.light_count <= LIGHT_LISTS;
}

static void add_generation(struct target *target, const struct gpu_generation *generation,
                           bool camera)
{
    bool by_light = stage_times_by_light(target->renderer);
    uint32_t rows = by_light ? target->renderer->frame.light_count : 1;
    uint64_t hits = 0;
    if (!camera)
        add_items(target, RENDER_STAGE_CLOSEST, items_of(generation, LIST_RAYS));
    for (uint32_t i = 0; i < target->stages.set.classes; ++i) {
        uint64_t items = items_of(generation, LIST_HITS + i);
        add_items(target, RENDER_STAGE_SHADE + i, items);
        hits += target->stages.set.calls[i] ? items : 0;
    }
    if (!camera)
        add_items(target, RENDER_STAGE_RESOLVE, hits);
    for (uint32_t i = 0; i < rows; ++i) {
        uint32_t rays = generation->lists[LIST_LIGHTS + i].shadow_rays;
        add_items(target, RENDER_STAGE_SHADOW + i, rays);
        target->stats.rays_shadow += rays;
    }
}

whit_result stage_times_end(struct target *target, const struct gpu_chunk *chunk,
                            uint32_t generations, uint32_t deferred)
{
    struct stage_times *times = &target->stages.times;
    uint64_t pixels = render_slots(chunk);
    add_items(target, RENDER_STAGE_CAMERA, pixels);
    add_items(target, RENDER_STAGE_RESOLVE, pixels);
    add_items(target, RENDER_STAGE_DEFERRED, deferred);
    struct gpu_generation *all = array_alloc(generations, sizeof *all);
    if (!all)
        return render_no_memory(target->renderer, "the counts of a tile");
    whit_result result = buffer_read(target->buffers.queues.generations,
                                     stages_generation_offset(0), all, generations * sizeof *all);
    for (uint32_t g = 0; result == WHIT_OK && g < generations; ++g)
        add_generation(target, &all[g], g == 0);
    if (result == WHIT_OK && times->on && !target->probed)
        result = material_shares_add(target, all, generations, (uint32_t)pixels);
    free(all);
    for (uint32_t row = 0; times->on && row < RENDER_STAGE_COUNT; ++row)
        target->timed[row].ms += times->ms[row];
    return result;
}

void stage_times_scale(const struct renderer *renderer, whit_stats *stats)
{
    static const char *const names[] = {"camera",      "closest", "shade",
                                        "shade glass", "resolve", "deferred"};
    bool by_light = stage_times_by_light(renderer);
    for (uint32_t row = 0; row < RENDER_STAGE_COUNT; ++row) {
        const struct stage_sample *timed = &renderer->picture.timed[row];
        whit_stage *stage = &stats->stages[row];
        if (row < RENDER_STAGE_SHADOW)
            snprintf(stage->name, sizeof stage->name, "%s", names[row]);
        else if (!by_light)
            snprintf(stage->name, sizeof stage->name, "shadows");
        else
            snprintf(stage->name, sizeof stage->name, "shadows of light %u",
                     row - RENDER_STAGE_SHADOW);
        stage->ms = timed->items ? timed->ms * (double)stage->rays / (double)timed->items : -1.0;
    }
    /* Blocks at the edges of the picture also have slots outside of it, without rays. */
    whit_stage *camera = &stats->stages[RENDER_STAGE_CAMERA];
    if (camera->rays > stats->rays_primary) {
        stats->stages[RENDER_STAGE_RESOLVE].rays -= camera->rays - stats->rays_primary;
        camera->rays = stats->rays_primary;
    }
}

/* One sample of a tile in stages: what its rays hit, what the surfaces there do with light, what
   comes from each light; then the same for the rays that these hits send, generation by generation;
   at last the sums, from the youngest generation back to the camera rays. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "base/clock.h"
#include "base/vec.h"
#include "device/buffer.h"
#include "device/commands.h"
#include "render/costs.h"
#include "render/hooks.h"
#include "render/pixels.h"
#include "render/queues.h"
#include "render/stage_set.h"
#include "render/stage_times.h"
#include "render/stages.h"
#include "render/tiles.h"
#include "render/variants.h"

/* Generations to record at once if a tile has more of them than the one before. */
enum { MORE_AT_ONCE = 2 };
/* A submission cannot be stopped. With all dispatches of a tile it would take seconds in a scene of
   thousands of lights, and Ctrl+C would have to wait for it. */
enum { DISPATCHES_A_SUBMISSION = 512 }; /* one with several lights counts as so many */

/* A tile on its way through the stages. */
struct tile_run {
    struct target *target;
    struct gpu_chunk chunk;
    const struct progress *progress;
    uint32_t dispatches; /* of the submission being recorded, as DISPATCHES_A_SUBMISSION counts */
    double longest_ms;   /* longest time of a submission so far */
};

uint64_t stages_generation_offset(uint32_t generation)
{
    return sizeof(struct gpu_tally) + (uint64_t)generation * sizeof(struct gpu_generation);
}

static size_t list_offset(uint32_t list)
{
    return offsetof(struct gpu_generation, lists) + list * sizeof(struct gpu_items);
}

/* The row of whit_stats.stages that a dispatch counts in: RENDER_STAGE_*. */
static uint32_t row_of(const struct tile_run *run, enum stage stage, uint32_t list)
{
    static const uint32_t rows[STAGE_COUNT] = {
        [STAGE_CAMERA] = RENDER_STAGE_CAMERA,      [STAGE_MISS] = RENDER_STAGE_CAMERA,
        [STAGE_CLOSEST] = RENDER_STAGE_CLOSEST,    [STAGE_SHADE] = RENDER_STAGE_SHADE,
        [STAGE_SHADOW] = RENDER_STAGE_SHADOW,      [STAGE_SHADE_GLASS] = RENDER_STAGE_SHADE_GLASS,
        [STAGE_SHADE_DIRECT] = RENDER_STAGE_SHADE, [STAGE_SHADOW_LATER] = RENDER_STAGE_SHADOW,
        [STAGE_RESOLVE] = RENDER_STAGE_RESOLVE,    [STAGE_RESOLVE_LATER] = RENDER_STAGE_RESOLVE,
        [STAGE_SHAPE] = RENDER_STAGE_CAMERA,       [STAGE_SHAPE_LIGHT] = RENDER_STAGE_SHADOW,
        [STAGE_POST] = RENDER_STAGE_RESOLVE,
    };
    if (stage >= STAGE_HIT && stage <= STAGE_AOV)
        return RENDER_STAGE_SHADE + (list - LIST_HITS);
    bool by_light =
        rows[stage] == RENDER_STAGE_SHADOW && stage_times_by_light(run->target->renderer);
    return rows[stage] + (by_light ? run->chunk.light : 0);
}

static whit_result begin_submission(struct tile_run *run)
{
    struct commands *commands = run->target->renderer->commands;
    whit_result result = commands_begin(commands);
    if (result != WHIT_OK)
        return result;
    commands_span_begin(commands, "tile");
    stage_times_submission(run->target);
    run->dispatches = 0;
    return WHIT_OK;
}

static bool has_direct(const struct target *target)
{
    return target->stages.set.passes[STAGE_SHADE_DIRECT].pipeline && !target->stages.no_direct;
}

/* Whether STAGE_SHADE_DIRECT shades the tile. Where stages are timed, it does not shade timed
   tiles, so that each light has its time, and the first tile, which makes machine code. */
static bool lights_directly(const struct tile_run *run)
{
    const struct target *target = run->target;
    const struct stage_times *times = &target->stages.times;
    bool timed = target->renderer->params.time_stages && (times->on || times->tiles <= 1);
    return has_direct(target) && !timed;
}

static whit_result finish_submission(struct tile_run *run)
{
    double start_ms = clock_ms();
    struct stages *stages = &run->target->stages;
    stages->may_cut = stages->set.lights_each > 1 || has_direct(run->target);
    whit_result result = render_finish_submission(run->target);
    stages->may_cut = false;
    stage_times_take(run->target);
    double spent_ms = clock_ms() - start_ms;
    run->longest_ms = fmax(run->longest_ms, spent_ms);
    return result;
}

/* Submits what was recorded and begins another submission, if this one has as many dispatches as
   allowed; in between it obeys requests to stop. */
static whit_result split_submission(struct tile_run *run)
{
    if (run->dispatches < DISPATCHES_A_SUBMISSION)
        return WHIT_OK;
    whit_result result = finish_submission(run);
    if (result == WHIT_OK)
        result = render_stop_asked(run->target->renderer, run->progress);
    if (result == WHIT_OK)
        result = begin_submission(run);
    if (result == WHIT_OK)
        commands_barrier(run->target->renderer->commands);
    return result;
}

/* Records one stage over one list of the generation run->chunk.generation. The device alone knows
   the number of workgroups, except for camera rays: one invocation for each pixel drawn of the
   chunk. */
static whit_result dispatch(struct tile_run *run, enum stage stage, uint32_t list)
{
    struct target *target = run->target;
    struct gpu_chunk *chunk = &run->chunk;
    struct commands *commands = target->renderer->commands;
    const struct pass *pass = &target->stages.set.passes[target->stages.set.of[stage]];
    struct buffer *deferred = target->buffers.queues.deferred;
    whit_result result = split_submission(run);
    if (result != WHIT_OK)
        return result;
    chunk->list = list;
    stage_times_next(target, row_of(run, stage, list));
    if (pass->deferred) {
        render_clear_deferred(target->renderer, deferred);
        commands_barrier(commands);
    }
    commands_bind(commands, pass->pipeline, pass->set);
    render_push_chunk(target->renderer, chunk);
    if (chunk->generation == 0 && list == LIST_RAYS)
        commands_dispatch(commands, (render_groups(chunk) + pass->rays_each - 1) / pass->rays_each,
                          1, 1);
    else
        commands_dispatch_indirect(commands, target->buffers.queues.generations,
                                   stages_generation_offset(chunk->generation) + list_offset(list));
    ++target->stats.dispatches;
    ++run->dispatches;
    if (pass->deferred) {
        struct gpu_chunk again = *chunk;
        again.deferred = 1;
        stage_times_next(target, RENDER_STAGE_DEFERRED);
        render_take_deferred(commands, pass->deferred, pass->deferred_set, deferred, &again,
                             sizeof again);
        ++target->stats.dispatches;
    }
    commands_barrier(commands);
    return WHIT_OK;
}

/* Records a stage of the user's functions, if the file has them. */
static whit_result dispatch_own(struct tile_run *run, enum stage stage, uint32_t list)
{
    bool has = run->target->stages.set.passes[stage].pipeline;
    return has ? dispatch(run, stage, list) : WHIT_OK;
}

static whit_result record_rays(struct tile_run *run)
{
    bool camera = run->chunk.generation == 0;
    whit_result result = dispatch_own(run, STAGE_SHAPE, LIST_RAYS);
    return result == WHIT_OK ? dispatch(run, camera ? STAGE_CAMERA : STAGE_CLOSEST, LIST_RAYS)
                             : result;
}

/* Records a stage of the user's functions over the hits of all classes. */
static whit_result record_own_hits(struct tile_run *run, enum stage stage)
{
    whit_result result = WHIT_OK;
    for (uint32_t i = 0; result == WHIT_OK && i < run->target->stages.set.classes; ++i)
        result = dispatch_own(run, stage, LIST_HITS + i);
    return result;
}

/* STAGE_HIT_CALL reads the rows of the dispatch before it: so the two parts alternate, class by
   class. */
static whit_result record_functions(struct tile_run *run)
{
    const struct stage_set *set = &run->target->stages.set;
    whit_result result = WHIT_OK;
    if (set->passes[STAGE_HIT].pipeline)
        return record_own_hits(run, STAGE_HIT);
    for (uint32_t i = 0; result == WHIT_OK && i < set->classes; ++i) {
        result = dispatch_own(run, STAGE_HIT_FETCH, LIST_HITS + i);
        if (result == WHIT_OK)
            result = dispatch_own(run, STAGE_HIT_CALL, LIST_HITS + i);
    }
    return result;
}

/* The user's functions come first, since shading a shadow catcher overwrites the row of its hit. */
static whit_result record_hits(struct tile_run *run)
{
    whit_result result = record_functions(run);
    if (result == WHIT_OK && run->chunk.generation == 0)
        result = record_own_hits(run, STAGE_AOV);
    if (result == WHIT_OK)
        result = dispatch(run, lights_directly(run) ? STAGE_SHADE_DIRECT : STAGE_SHADE, LIST_HITS);
    if (result == WHIT_OK && run->target->stages.set.classes > 1)
        result = dispatch(run, STAGE_SHADE_GLASS, LIST_HITS + CLASS_GLASS);
    return result;
}

/* In a timed tile each light that has a row of its own has a dispatch of its own. */
static whit_result record_lights(struct tile_run *run)
{
    const struct target *target = run->target;
    const struct stage_set *set = &target->stages.set;
    bool camera = run->chunk.generation == 0, few = stage_times_by_light(target->renderer);
    bool asks = lights_directly(run) ? set->asks_directly : set->asks;
    uint32_t lights = asks ? target->renderer->frame.light_count : 0;
    uint32_t each = few && target->stages.times.on ? 1 : set->lights_each;
    whit_result result = WHIT_OK;
    for (uint32_t i = 0; result == WHIT_OK && i < lights; i += each) {
        uint32_t list = LIST_LIGHTS + (few && !set->shares_hits ? i : 0);
        run->chunk.light = i;
        run->chunk.lights = lights - i < each ? lights - i : each;
        result = dispatch_own(run, STAGE_SHAPE_LIGHT, list);
        if (result == WHIT_OK)
            result = dispatch(run, camera ? STAGE_SHADOW : STAGE_SHADOW_LATER, list);
        run->dispatches += run->chunk.lights - 1;
    }
    return result;
}

static whit_result record_generation(struct tile_run *run)
{
    whit_result result = record_rays(run);
    if (result == WHIT_OK)
        result = dispatch_own(run, STAGE_MISS, LIST_RAYS);
    if (result == WHIT_OK)
        result = record_hits(run);
    return result == WHIT_OK ? record_lights(run) : result;
}

/* Records the sums, from generation `count` - 1 back to the camera rays. The kernels do nothing if
   generation `count` has rays. */
static whit_result record_resolve(struct tile_run *run, uint32_t count)
{
    const struct stage_set *set = &run->target->stages.set;
    whit_result result = WHIT_OK;
    run->chunk.light = count;
    for (run->chunk.generation = count; --run->chunk.generation > 0;) {
        for (uint32_t i = 0; result == WHIT_OK && i < set->classes; ++i) {
            if (set->calls[i])
                result = dispatch(run, STAGE_RESOLVE_LATER, LIST_HITS + i);
        }
    }
    if (result == WHIT_OK)
        result = dispatch(run, STAGE_RESOLVE, LIST_RAYS);
    bool last = run->chunk.summed + 1 == run->chunk.samples;
    return result == WHIT_OK && last ? dispatch_own(run, STAGE_POST, LIST_RAYS) : result;
}

static void clear_queues(struct target *target)
{
    const struct queue_buffers *queues = &target->buffers.queues;
    struct commands *commands = target->renderer->commands;
    commands_fill(commands, target->buffers.status, 0, 4, 0);
    commands_copy(commands, queues->empty, 0, queues->generations, 0,
                  stages_generation_offset(queues->generation_count));
    const struct pixel_buffers *pixels = &target->buffers;
    if (pixels->aovs) /* pixels whose ray hits nothing keep these zeros */
        commands_fill(commands, pixels->aovs, 0,
                      (uint64_t)pixels->chunk_slots * hooks_aov_count(target) * 16, 0);
    if (queues->cuts)
        commands_fill(commands, queues->cuts, 0, buffer_size(queues->cuts), 0);
}

/* Traces generations `first` to `end` - 1 of a tile, and adds up what they bring. */
static whit_result trace_generations(struct tile_run *run, uint32_t first, uint32_t end)
{
    whit_result result = begin_submission(run);
    if (result != WHIT_OK)
        return result;
    if (first == 0)
        clear_queues(run->target);
    commands_barrier(run->target->renderer->commands);
    for (uint32_t g = first; result == WHIT_OK && g < end; ++g) {
        run->chunk.generation = g;
        result = record_generation(run);
    }
    if (result == WHIT_OK)
        result = record_resolve(run, end);
    return result == WHIT_OK ? finish_submission(run) : result;
}

/* Draws only the aovs of a tile: camera rays, the aov stage, and the sums of aovs. */
static whit_result draw_aovs(struct tile_run *run)
{
    run->target->stages.times.on = false;
    run->chunk.aovs_alone = 1;
    run->chunk.generation = 0;
    run->chunk.light = GENERATION_NONE;
    whit_result result = begin_submission(run);
    if (result != WHIT_OK)
        return result;
    clear_queues(run->target);
    commands_barrier(run->target->renderer->commands);
    result = record_rays(run);
    if (result == WHIT_OK)
        result = record_own_hits(run, STAGE_AOV);
    if (result == WHIT_OK)
        result = dispatch(run, STAGE_RESOLVE, LIST_RAYS);
    return result == WHIT_OK ? finish_submission(run) : result;
}

static whit_result take_tally(struct target *target)
{
    whit_stats *stats = &target->stats;
    struct gpu_tally tally;
    whit_result result = buffer_read(target->buffers.queues.generations, 0, &tally, sizeof tally);
    if (result != WHIT_OK)
        return result;
    stats->weight_cut_depth =
        fmax(stats->weight_cut_depth, (double)float_of_bits(tally.cut_depth_weight));
    stats->weight_cut_bailout =
        fmax(stats->weight_cut_bailout, (double)float_of_bits(tally.cut_bailout_weight));
    stats->rays_reflected += tally.reflected;
    stats->rays_refracted += tally.refracted;
    stats->rays_by_functions += tally.by_functions;
    stats->rays_cut_depth += tally.cut_depth;
    stats->rays_cut_bailout += tally.cut_bailout;
    return WHIT_OK;
}

/* Reads the number of rays of a generation that was not traced yet. */
static whit_result count_left(struct target *target, uint32_t generation, uint32_t *rays)
{
    struct gpu_generation head = {0};
    whit_result result = WHIT_OK;
    if (target->renderer->has_secondary)
        result = buffer_read(target->buffers.queues.generations,
                             stages_generation_offset(generation), &head, sizeof head);
    *rays = head.lists[LIST_RAYS].front + head.lists[LIST_RAYS].back;
    return result;
}

/* Draws a tile; its pixels stay as they are if a queue overflows, or loops are cut short that
   several lights share. */
static whit_result draw_tile(struct target *target, const struct gpu_chunk *tile,
                             const struct progress *progress, double *longest_ms)
{
    struct renderer *renderer = target->renderer;
    struct stages *stages = &target->stages;
    const struct queue_buffers *queues = &target->buffers.queues;
    struct tile_run run = {.target = target, .chunk = *tile, .progress = progress};
    run.chunk.ray_capacity = queues->ray_capacity;
    run.chunk.lit_capacity = queues->lit_capacity;
    uint32_t done = 0, end = stages->expected, left = 1, deferred = 0, deferred_before = 0;
    whit_result result = WHIT_OK;
    if (progress->aovs_alone) {
        result = draw_aovs(&run);
        *longest_ms = fmax(*longest_ms, run.longest_ms);
        return result;
    }
    stage_times_begin(target);
    result = deferred_read(target, &deferred_before);
    if (result != WHIT_OK)
        return result;
    while (left > 0) {
        result = done > 0 ? render_stop_asked(renderer, progress) : WHIT_OK;
        if (result == WHIT_OK && end >= queues->generation_count)
            result =
                log_failure(&renderer->log, WHIT_ERROR_STATUS, "a ray passes more than %u surfaces",
                            queues->generation_count - 1);
        if (result == WHIT_OK)
            result = trace_generations(&run, done, end);
        *longest_ms = fmax(*longest_ms, run.longest_ms);
        if (result == WHIT_OK && !stages->full && !stages->cut)
            result = count_left(target, end, &left);
        if (result != WHIT_OK || stages->full || stages->cut)
            return result;
        done = end;
        end += MORE_AT_ONCE;
    }
    stages->expected = done;
    result = deferred_read(target, &deferred);
    if (result == WHIT_OK)
        result = stage_times_end(target, tile, done, deferred - deferred_before);
    if (result == WHIT_OK && !target->probed)
        result = costs_add(target, tile);
    return result == WHIT_OK ? take_tally(target) : result;
}

/* If loops are cut short that several lights share, the tile is drawn again, and from then on each
   light has its own dispatch, and no light is added while shading. If a queue overflows, the tile
   is drawn again in halves. */
whit_result stages_sample(struct target *target, const struct gpu_chunk *chunk,
                          const struct progress *progress, double *longest_ms)
{
    whit_result result = draw_tile(target, chunk, progress, longest_ms);
    if (result == WHIT_OK && target->stages.cut) {
        target->stages.set.lights_each = 1;
        target->stages.no_direct = true;
        result = stages_complete(target);
        if (result == WHIT_OK)
            result = draw_tile(target, chunk, progress, longest_ms);
    }
    if (result != WHIT_OK || !target->stages.full)
        return result;
    if (chunk->block_count == 1 && queues_can_grow(target)) {
        result = queues_grow(target);
        stages_unbind(&target->stages);
        if (result == WHIT_OK)
            result = stages_bind(target);
        if (result == WHIT_OK)
            return stages_sample(target, chunk, progress, longest_ms);
        target_drop_pixels(target); /* queues are missing: the next picture makes all anew */
        return result;
    }
    if (chunk->block_count == 1)
        return log_failure(&target->renderer->log, WHIT_ERROR_MEMORY,
                           "there is no room for the rays of %d pixels at depth %u and bailout %g",
                           RENDER_BLOCK_PIXELS, target->renderer->params.depth,
                           target->renderer->params.bailout);
    uint32_t end = chunk->first_block + chunk->block_count;
    uint32_t max = (chunk->block_count + 1) / 2;
    struct gpu_chunk part = *chunk;
    target->stages.blocks_max = max;
    for (; result == WHIT_OK && part.first_block < end;
         part.first_block += max, part.tile_slot += max * RENDER_BLOCK_PIXELS) {
        part.block_count = end - part.first_block < max ? end - part.first_block : max;
        result = stages_sample(target, &part, progress, longest_ms);
    }
    return result;
}

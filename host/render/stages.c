/* One sample of a tile in stages: what its rays meet, what the surfaces there do with light, what
   comes from each light; then the same for the rays that these call for, generation by generation;
   last the sums, from the youngest generation to the camera rays. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "base/clock.h"
#include "base/threads.h"
#include "base/vec.h"
#include "device/buffer.h"
#include "device/commands.h"
#include "device/pipeline.h"
#include "render/adaptive_samples.h"
#include "render/costs.h"
#include "render/hooks.h"
#include "render/queues.h"
#include "render/stage_times.h"
#include "render/stages.h"
#include "render/tiles.h"
#include "render/translation.h"
#include "render/variants.h"

/* Generations of the first tile, before it is known how many there are. */
enum { EXPECTED_FIRST = 4, MORE_AT_ONCE = 2 };
/* A submission cannot be stopped. One of all the dispatches of a tile takes seconds in a scene of
   thousands of lights, and Ctrl+C would wait for it. */
enum { DISPATCHES_A_SUBMISSION = 512 };

/* A tile on its way through the stages. */
struct tile_run {
    struct target *target;
    struct gpu_chunk chunk;
    const struct progress *progress;
    uint32_t dispatches; /* of the submission in the making */
    double longest_ms;   /* of those before */
};

/* One kernel for camera rays and later ones, where nothing but that tells the two apart. */
static void share_kernel(struct stages_job *job, enum stage first, enum stage later)
{
    struct gpu_spec spec = job->stages[first].spec;
    if (!job->wanted[later])
        return;
    spec.SPEC_GENERATIONS = job->stages[later].spec.SPEC_GENERATIONS;
    if (memcmp(&spec, &job->stages[later].spec, sizeof spec) != 0)
        return;
    job->stages[later].spec.SPEC_GENERATIONS = 3;
    job->wanted[first] = false;
    job->of[first] = later;
}

void stages_job_init(const struct target *target, const struct gpu_spec *spec, bool own, bool few,
                     struct stages_job *job)
{
    const struct renderer *renderer = target->renderer;
    const whit_shader *shader = renderer->params.shader;
    *job = (struct stages_job){.spec = *spec};
    /* A shading function of the user's has asked them itself, as all but catchers do. */
    job->asks = !shader_has(shader, WHIT_HOOK_SHADE) || spec->SPEC_CATCHERS;
    job->classes = own ? variant_classes(target) : 1;
    bool splits = variant_splits_hits(target);
    for (int i = 0; i < STAGE_COUNT; ++i) {
        job->of[i] = (enum stage)i;
        bool shadow = i == STAGE_SHADOW || i == STAGE_SHADOW_LATER;
        bool later = i == STAGE_CLOSEST || i == STAGE_SHADOW_LATER || i == STAGE_RESOLVE_LATER;
        bool part = i == STAGE_HIT_FETCH || i == STAGE_HIT_CALL;
        job->wanted[i] = (!shadow || job->asks) && (!later || renderer->has_secondary) &&
                         (!part || splits) && (i != STAGE_HIT || !splits) &&
                         (i != STAGE_MISS || shader_has(shader, WHIT_HOOK_MISS)) &&
                         (i != STAGE_SHAPE || shader_has(shader, WHIT_HOOK_INTERSECT)) &&
                         (i != STAGE_HIT || shader_has(shader, WHIT_HOOK_SURFACE) ||
                          shader_has(shader, WHIT_HOOK_SHADE)) &&
                         (i != STAGE_AOV || spec->SPEC_AOVS > 0) &&
                         (i != STAGE_POST || shader_has(shader, WHIT_HOOK_POST)) &&
                         (i != STAGE_SHADE_GLASS || job->classes == CLASSES_MAX);
        if (job->wanted[i])
            variant_job_init(target, spec, job->classes, (enum stage)i, &job->stages[i]);
    }
    if (!few)
        return;
    share_kernel(job, STAGE_CAMERA, STAGE_CLOSEST);
    share_kernel(job, STAGE_SHADOW, STAGE_SHADOW_LATER);
    share_kernel(job, STAGE_RESOLVE, STAGE_RESOLVE_LATER);
}

/* A set in the making: stages are made at once, as far as there are threads. */
struct set_making {
    struct device *device;
    const struct stages_job *job;
    struct stage_set *set;
    whit_result results[STAGE_COUNT];
};

static void make_stage(void *context, uint32_t i)
{
    struct set_making *making = context;
    if (making->job->wanted[i])
        making->results[i] =
            variant_job_run(making->device, &making->job->stages[i], &making->set->passes[i]);
}

whit_result stages_job_run(struct device *device, const struct stages_job *job,
                           struct stage_set *out)
{
    struct set_making making = {.device = device, .job = job, .set = out};
    whit_result result = WHIT_OK;
    *out = (struct stage_set){.classes = job->classes, .asks = job->asks};
    memcpy(out->of, job->of, sizeof out->of);
    for (uint32_t i = 0; i < job->classes; ++i)
        out->calls[i] = variant_calls_rays(&job->stages[STAGE_SHADE + i].spec) ||
                        job->spec.SPEC_PROBE; /* there sums are recorded */
    threads_for(device_compile_threads(device), STAGE_COUNT, make_stage, &making);
    for (int i = 0; result == WHIT_OK && i < STAGE_COUNT; ++i)
        result = making.results[i];
    if (result != WHIT_OK)
        stage_set_finish(out);
    return result;
}

void stage_set_finish(struct stage_set *set)
{
    for (int i = 0; i < STAGE_COUNT; ++i)
        pass_finish(&set->passes[i]);
    *set = (struct stage_set){0};
}

bool stage_set_is_made(const struct stage_set *set)
{
    return set->passes[set->of[STAGE_CAMERA]].pipeline != NULL;
}

bool stages_are_made(const struct target *target)
{
    return stage_set_is_made(&target->stages.set);
}

whit_result stages_bind(struct target *target)
{
    struct stages *stages = &target->stages;
    whit_result result = WHIT_OK;
    if (stages->set.passes[stages->set.of[STAGE_CAMERA]].set)
        return WHIT_OK;
    for (int i = 0; result == WHIT_OK && i < STAGE_COUNT; ++i) {
        if (stages->set.passes[i].pipeline)
            result = variant_bind_stage(target, &stages->set.passes[i]);
    }
    stages->expected = !target->renderer->has_secondary    ? 1
                       : stages->expected > EXPECTED_FIRST ? stages->expected
                                                           : EXPECTED_FIRST;
    if (result != WHIT_OK)
        stages_unbind(stages);
    return result;
}

static void count_instructions(struct target *target)
{
    target->stats.kernel_instructions = 0;
    for (int i = 0; i < STAGE_COUNT; ++i) {
        const struct pass *pass = &target->stages.set.passes[i];
        struct pipeline_info info = {0};
        bool idle = i == STAGE_HIT_FETCH && target->stages.set.passes[STAGE_HIT].pipeline;
        if (pass->pipeline && !idle)
            pipeline_get_info(pass->pipeline, &info);
        target->stats.kernel_instructions += info.instructions;
    }
}

whit_result stages_take(struct target *target, struct stage_set *set)
{
    stage_set_finish(&target->stages.set);
    target->stages.set = *set;
    *set = (struct stage_set){0};
    count_instructions(target);
    return stages_bind(target);
}

/* Whether two stages have different kernels. `closely`: kernels whose words differ are specialized
   and compared again. Where rays may wait for a second kernel words decide, for that one is not
   compared. */
static bool is_other(const struct variant_job *a, const struct variant_job *b, bool closely)
{
    struct gpu_spec second;
    bool same_words = a->params.spirv_bytes == b->params.spirv_bytes &&
                      memcmp(a->params.spirv, b->params.spirv, a->params.spirv_bytes) == 0;
    return memcmp(&a->spec, &b->spec, sizeof a->spec) != 0 ||
           (!same_words && !(closely && !variant_defers(&b->params, &second) &&
                             pipeline_is_same(&a->params, &b->params)));
}

/* Whether both have a kernel of the stage. */
static bool both_have(const struct stages_job *a, const struct stages_job *b, enum stage stage)
{
    return a->wanted[stage] && b->wanted[stage];
}

/* Leaves in `job` the kernels that are others than those of `was`. */
static void drop_same(const struct stages_job *was, bool same, struct stages_job *job)
{
    /* Ids in other kernels move where a function that has one of its own is another. */
    static const enum stage own[] = {STAGE_SHAPE, STAGE_HIT,  STAGE_HIT_CALL,
                                     STAGE_AOV,   STAGE_MISS, STAGE_POST};
    for (int i = 0; i < STAGE_COUNT; ++i) {
        bool closely = false;
        for (size_t k = 0; k < sizeof own / sizeof *own; ++k)
            closely = closely || ((int)own[k] != i && both_have(was, job, own[k]));
        job->wanted[i] = job->wanted[i] && (!same || !was->wanted[i] ||
                                            is_other(&was->stages[i], &job->stages[i], closely));
    }
}

/* Where the kernel of shade() is another and `splits`, only its parts are made. */
static void put_off_hits(bool splits, struct stage_set *set, struct stages_job *job)
{
    if (!splits || job->wanted[STAGE_HIT_FETCH])
        pass_finish(&set->passes[STAGE_HIT_FETCH]);
    if (!splits || job->wanted[STAGE_HIT_CALL])
        pass_finish(&set->passes[STAGE_HIT_CALL]);
    if (splits && job->wanted[STAGE_HIT_CALL])
        pass_finish(&set->passes[STAGE_HIT]);
    bool needed = splits && !set->passes[STAGE_HIT].pipeline;
    job->wanted[STAGE_HIT_FETCH] = needed && !set->passes[STAGE_HIT_FETCH].pipeline;
    job->wanted[STAGE_HIT_CALL] = needed && !set->passes[STAGE_HIT_CALL].pipeline;
}

whit_result stages_replace(struct target *target, const whit_shader *before)
{
    struct renderer *renderer = target->renderer;
    struct stage_set *set = &target->stages.set, made;
    const whit_shader *shader = renderer->params.shader;
    struct stages_job was, job;
    struct gpu_spec spec;
    bool few = variant_few_kernels(target);
    renderer->kept.known &= stages_are_made(target);
    if (!stages_are_made(target))
        return WHIT_OK;
    renderer->params.shader = before;
    spec = variant_spec(target);
    stages_job_init(target, &spec, true, few, &was);
    renderer->params.shader = shader;
    spec = variant_spec(target);
    stages_job_init(target, &spec, true, few, &job);
    bool same = was.classes == job.classes && memcmp(was.of, job.of, sizeof job.of) == 0;
    drop_same(&was, same, &job);
    put_off_hits(variant_splits_hits(target), set, &job);
    for (int i = 0; i < STAGE_COUNT; ++i)
        renderer->kept.known &= !job.wanted[i] || i == STAGE_AOV || i == STAGE_POST;
    renderer->kept.aovs &= !job.wanted[STAGE_AOV];
    whit_result result = stages_job_run(renderer->device, &job, &made);
    if (result != WHIT_OK || !same)
        stage_set_finish(set);
    if (result != WHIT_OK)
        return result;
    stages_unbind(&target->stages);
    for (int i = 0; i < STAGE_COUNT; ++i) {
        if (job.wanted[i] || !same) {
            pass_finish(&set->passes[i]);
            set->passes[i] = made.passes[i];
        }
    }
    set->classes = made.classes;
    memcpy(set->of, made.of, sizeof set->of);
    memcpy(set->calls, made.calls, sizeof set->calls);
    count_instructions(target);
    return WHIT_OK;
}

/* Makes the kernel of shade() whose parts have stood in for it. */
static whit_result make_hits(struct target *target)
{
    struct stage_set *set = &target->stages.set, made;
    struct gpu_spec spec = variant_spec(target);
    struct stages_job job;
    stages_job_init(target, &spec, true, variant_few_kernels(target), &job);
    for (int i = 0; i < STAGE_COUNT; ++i)
        job.wanted[i] = i == STAGE_HIT;
    whit_result result = stages_job_run(target->renderer->device, &job, &made);
    if (result != WHIT_OK)
        return result;
    stages_unbind(&target->stages);
    set->passes[STAGE_HIT] = made.passes[STAGE_HIT];
    pass_finish(&set->passes[STAGE_HIT_CALL]);
    count_instructions(target);
    return WHIT_OK;
}

whit_result stages_complete(struct target *target)
{
    bool parts = target->stages.set.passes[STAGE_HIT_CALL].pipeline;
    whit_result result = parts && !variant_splits_hits(target) ? make_hits(target) : WHIT_OK;
    return result == WHIT_OK ? stages_bind(target) : result;
}

whit_result stages_compile(struct target *target)
{
    struct stages_job job;
    struct stage_set set;
    struct gpu_spec spec = variant_spec(target);
    if (stages_are_made(target))
        return stages_bind(target);
    stages_job_init(target, &spec, true, variant_few_kernels(target), &job);
    whit_result result = stages_job_run(target->renderer->device, &job, &set);
    if (result == WHIT_OK)
        result = stages_take(target, &set);
    return result == WHIT_OK ? translation_share(target, &job) : result;
}

static uint32_t count_bits(uint64_t bits)
{
    uint32_t count = 0;
    for (; bits; bits &= bits - 1)
        ++count;
    return count;
}

/* Counts all kernels of a set: the sum of their instructions, the bindings that any of them uses,
   and the instructions of the largest one. False: a kernel cannot be specialized. */
static bool count_set(const struct stages_job *job, struct pipeline_info *sum, uint32_t *largest)
{
    *sum = (struct pipeline_info){0};
    *largest = 0;
    for (int i = 0; i < STAGE_COUNT; ++i) {
        struct pipeline_info info = {0};
        if (job->wanted[i] && !pipeline_count(&job->stages[i].params, &info))
            return false;
        sum->instructions += info.instructions;
        sum->bindings |= info.bindings;
        *largest = info.instructions > *largest ? info.instructions : *largest;
    }
    return true;
}

whit_result renderer_get_kernel(const struct renderer *renderer, whit_kernel_info *info)
{
    const struct target *target = &renderer->picture;
    struct gpu_spec own = variant_spec(target), general = variant_general_spec(target);
    struct stages_job job;
    struct pipeline_info own_info, general_info;
    uint32_t largest, general_largest;
    *info = (whit_kernel_info){0};
    bool few = variant_few_kernels(target);
    stages_job_init(target, &own, true, few, &job);
    bool counted = count_set(&job, &own_info, &largest);
    stages_job_init(target, &general, false, few, &job);
    if (!counted || !count_set(&job, &general_info, &general_largest)) {
        log_error(&renderer->log, "the kernels cannot be specialized");
        return WHIT_ERROR_DEVICE;
    }
    *info = (whit_kernel_info){
        .instructions = own_info.instructions,
        .largest_instructions = largest,
        .general_instructions = general_info.instructions,
        .bindings = count_bits(own_info.bindings),
        .general_bindings = count_bits(general_info.bindings),
    };
    return WHIT_OK;
}

void stages_unbind(struct stages *stages)
{
    for (int i = 0; i < STAGE_COUNT; ++i)
        pass_unbind(&stages->set.passes[i]);
    stages->blocks_max = 0;
}

uint64_t stages_generation_offset(uint32_t generation)
{
    return sizeof(struct gpu_tally) + (uint64_t)generation * sizeof(struct gpu_generation);
}

static size_t list_offset(uint32_t list)
{
    return offsetof(struct gpu_generation, lists) + list * sizeof(struct gpu_items);
}

/* A row of the prices of stages. */
static uint32_t row_of(enum stage stage, uint32_t list)
{
    static const uint32_t rows[STAGE_COUNT] = {
        [STAGE_CAMERA] = RENDER_STAGE_CAMERA,
        [STAGE_MISS] = RENDER_STAGE_CAMERA,
        [STAGE_CLOSEST] = RENDER_STAGE_CLOSEST,
        [STAGE_SHADE] = RENDER_STAGE_SHADE,
        [STAGE_SHADOW] = RENDER_STAGE_SHADOW,
        [STAGE_SHADE_GLASS] = RENDER_STAGE_SHADE_GLASS,
        [STAGE_SHADOW_LATER] = RENDER_STAGE_SHADOW,
        [STAGE_RESOLVE] = RENDER_STAGE_RESOLVE,
        [STAGE_RESOLVE_LATER] = RENDER_STAGE_RESOLVE,
        [STAGE_SHAPE] = RENDER_STAGE_CAMERA,
        [STAGE_POST] = RENDER_STAGE_RESOLVE,
    };
    if (stage == STAGE_SHAPE && list != LIST_RAYS)
        stage = STAGE_SHADOW;
    if (stage >= STAGE_HIT && stage <= STAGE_AOV)
        return RENDER_STAGE_SHADE + (list - LIST_HITS);
    return rows[stage] + (rows[stage] == RENDER_STAGE_SHADOW ? list - LIST_LIGHTS : 0);
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

static whit_result finish_submission(struct tile_run *run)
{
    double start_ms = clock_ms();
    whit_result result = render_finish_submission(run->target);
    stage_times_take(run->target);
    double spent_ms = clock_ms() - start_ms;
    run->longest_ms = fmax(run->longest_ms, spent_ms);
    return result;
}

/* Submits what was recorded and begins anew where the submission has as many dispatches as one may
   have; stops there if that is asked for. */
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

/* Records one stage over one list of the generation run->chunk.generation. How many workgroups that
   takes is known to the device alone, but for camera rays: one for each listed pixel of the chunk.
 */
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
    stage_times_next(target, row_of(stage, list));
    if (pass->deferred) {
        render_clear_deferred(target->renderer, deferred);
        commands_barrier(commands);
    }
    commands_bind(commands, pass->pipeline, pass->set);
    commands_push(commands, chunk, sizeof *chunk);
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
        render_take_deferred(target, pass, deferred, &again, sizeof again);
    }
    commands_barrier(commands);
    return WHIT_OK;
}

/* A stage of a user's functions, where the file has them. */
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

/* A stage of a user's functions over the hits of all classes. */
static whit_result record_own_hits(struct tile_run *run, enum stage stage)
{
    whit_result result = WHIT_OK;
    for (uint32_t i = 0; result == WHIT_OK && i < run->target->stages.set.classes; ++i)
        result = dispatch_own(run, stage, LIST_HITS + i);
    return result;
}

/* The rows that STAGE_HIT_CALL takes are those of the dispatch before it. */
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

/* Functions of users come first: where a shadow catcher is shaded there is no hit any more. */
static whit_result record_hits(struct tile_run *run)
{
    whit_result result = record_functions(run);
    if (result == WHIT_OK && run->chunk.generation == 0)
        result = record_own_hits(run, STAGE_AOV);
    if (result == WHIT_OK)
        result = dispatch(run, STAGE_SHADE, LIST_HITS);
    if (result == WHIT_OK && run->target->stages.set.classes > 1)
        result = dispatch(run, STAGE_SHADE_GLASS, LIST_HITS + CLASS_GLASS);
    return result;
}

static whit_result record_lights(struct tile_run *run)
{
    const struct renderer *renderer = run->target->renderer;
    bool camera = run->chunk.generation == 0, by_light = renderer->frame.light_count <= LIGHT_LISTS;
    bool shadows = renderer_compiles(renderer, SCENE_EFFECT_SHADOWS);
    whit_result result = WHIT_OK;
    uint32_t lights = run->target->stages.set.asks ? renderer->frame.light_count : 0;
    for (uint32_t i = 0; result == WHIT_OK && i < lights; ++i) {
        uint32_t list = LIST_LIGHTS + (by_light ? i : 0);
        run->chunk.light = i;
        if (shadows)
            result = dispatch_own(run, STAGE_SHAPE, list);
        if (result == WHIT_OK)
            result = dispatch(run, camera ? STAGE_SHADOW : STAGE_SHADOW_LATER, list);
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

/* From the last generation to the camera rays. Does nothing where generation `count` has rays. */
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
    if (pixels->aovs) /* of what is met nowhere */
        commands_fill(commands, pixels->aovs, 0,
                      (uint64_t)pixels->chunk_slots * hooks_aov_count(target) * 16, 0);
    if (queues->cuts)
        commands_fill(commands, queues->cuts, 0, buffer_size(queues->cuts), 0);
}

/* Generations `first` to `end` of a tile, and what they sum up to. */
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

/* Draws the aovs of a tile alone: camera rays, the aov stage, and the sums of aovs. */
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

/* How many rays wait in a generation that was not traced yet. */
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

/* Leaves the pixels alone where a queue gets full. */
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
        if (result == WHIT_OK && end >= queues->generation_count) {
            log_error(&renderer->log, "a ray passes more than %u surfaces",
                      queues->generation_count - 1);
            result = WHIT_ERROR_STATUS;
        }
        if (result == WHIT_OK)
            result = trace_generations(&run, done, end);
        *longest_ms = fmax(*longest_ms, run.longest_ms);
        if (result == WHIT_OK && !stages->full)
            result = count_left(target, end, &left);
        if (result != WHIT_OK || stages->full)
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

/* Where a queue gets full, in halves. */
whit_result stages_sample(struct target *target, const struct gpu_chunk *chunk,
                          const struct progress *progress, double *longest_ms)
{
    whit_result result = draw_tile(target, chunk, progress, longest_ms);
    if (result != WHIT_OK || !target->stages.full)
        return result;
    if (chunk->block_count == 1 && queues_can_grow(target)) {
        result = queues_grow(target);
        stages_unbind(&target->stages);
        if (result == WHIT_OK)
            result = stages_bind(target);
        return result == WHIT_OK ? stages_sample(target, chunk, progress, longest_ms) : result;
    }
    if (chunk->block_count == 1) {
        log_error(&target->renderer->log, "there is no room for the rays of %d pixels",
                  RENDER_BLOCK_PIXELS);
        return WHIT_ERROR_STATUS;
    }
    uint32_t end = chunk->first_block + chunk->block_count;
    uint32_t max = (chunk->block_count + 1) / 2;
    struct gpu_chunk part = *chunk;
    target->stages.blocks_max = max;
    for (; result == WHIT_OK && part.first_block < end;
         part.first_block += max, part.sums_row += max * RENDER_BLOCK_PIXELS) {
        part.block_count = end - part.first_block < max ? end - part.first_block : max;
        if (progress->listed)
            result = adaptive_list(target, progress, &part);
        if (result == WHIT_OK && (!progress->listed || part.listed > 0))
            result = stages_sample(target, &part, progress, longest_ms);
    }
    part = *chunk;
    if (result == WHIT_OK && progress->listed) /* for the next sample */
        result = adaptive_list(target, progress, &part);
    return result;
}

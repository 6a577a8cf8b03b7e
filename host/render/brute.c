/* Pictures without trees: every ray against every triangle, in dispatches short enough for drivers
   that end long loops, and only when it will not take too long. */
#include <stdlib.h>

#include "base/array.h"
#include "base/clock.h"
#include "render/renderer.h"

enum {
    /* Loop turns of a dispatch: a quarter of what lavapipe grants. */
    RANGE_TURNS = 1 << 14,
    CROPS = 5,
    CROP_BLOCKS_MIN = 4,
    CROP_BLOCKS_MAX = 64,
    CROP_WORK = 1 << 20, /* blocks x records of a crop, between these */
};
static const double LIMIT_DEFAULT_S = 60.0;
/* Spent on the estimate, unless one crop takes longer. */
static const double ESTIMATE_MS = 1000.0;

/* ---- The list of runs ---- */

struct listing {
    struct gpu_run *runs;
    uint32_t count, capacity;
    struct brute_range *ranges;
    uint32_t range_count, range_capacity;
    uint32_t turns; /* of the range that is open; 0: none is */
};

static bool range_end(struct listing *l)
{
    if (l->turns == 0)
        return true;
    l->ranges[l->range_count - 1].turns = l->turns;
    l->turns = 0;
    return ARRAY_PUSH(l->runs, l->count, l->capacity, (struct gpu_run){0});
}

/* Records [first, first + count) of an instance, over as many ranges as it takes. A run costs a
   turn on top of its records. */
static bool list_records(struct listing *l, uint32_t instance, uint32_t first, uint32_t count)
{
    bool begins = true;
    while (count > 0) {
        if (l->turns + 1 >= RANGE_TURNS && !range_end(l))
            return false;
        struct brute_range range = {.first_run = l->count};
        if (l->turns == 0 && !ARRAY_PUSH(l->ranges, l->range_count, l->range_capacity, range))
            return false;
        uint32_t room = RANGE_TURNS - l->turns - 1;
        struct gpu_run run = {
            .instance = instance, .first = first, .count = count < room ? count : room};
        run.begins = begins;
        if (!ARRAY_PUSH(l->runs, l->count, l->capacity, run))
            return false;
        begins = false;
        first += run.count;
        count -= run.count;
        l->turns += run.count + 1;
    }
    return true;
}

static bool list_all(const struct accel *accel, struct listing *l)
{
    if (accel->flat)
        return list_records(l, 0, accel->meshes[0].first_triangle, accel->meshes[0].record_count) &&
               range_end(l);
    for (uint32_t i = 0; i < accel->instance_count; ++i) {
        const struct gpu_instance *instance = &accel->instances[i];
        if (!list_records(l, i, instance->root, instance->record_count))
            return false;
    }
    return range_end(l);
}

/* Even nothing is a range: it begins the hit. */
static bool list_nothing(struct listing *l)
{
    return l->range_count > 0 ||
           (ARRAY_PUSH(l->ranges, l->range_count, l->range_capacity, (struct brute_range){0}) &&
            ARRAY_PUSH(l->runs, l->count, l->capacity, (struct gpu_run){0}));
}

whit_result brute_create(struct renderer *renderer)
{
    struct brute_state *brute = &renderer->brute;
    struct listing l = {0};
    if (!renderer->accel->no_trees)
        return WHIT_OK;
    if (renderer->params.numerics == NUMERICS_EXACT) { /* keys do not outlive a dispatch */
        log_error(&renderer->log, "exact numerics need trees on a device");
        return WHIT_ERROR_USAGE;
    }
    uint64_t before = renderer->scene_buffers.bytes;
    whit_result result = WHIT_OK;
    if (!list_all(renderer->accel, &l) || !list_nothing(&l)) {
        log_error(&renderer->log, "out of memory for the list of what rays test");
        result = WHIT_ERROR_MEMORY;
    }
    if (result == WHIT_OK)
        result = upload_words(renderer, l.runs, (uint64_t)l.count * sizeof *l.runs, BUFFER_STORAGE,
                              "runs", &brute->runs);
    free(l.runs);
    brute->ranges = l.ranges;
    brute->range_count = l.range_count;
    uint64_t slots = renderer->pixel_buffers.chunk_slots;
    uint64_t turns = lights_turns(renderer) ? lights_turns(renderer) : 1;
    if (result == WHIT_OK)
        result = buffer_create(renderer->device, slots * sizeof(struct gpu_found), BUFFER_STORAGE,
                               "hits so far", &brute->found);
    if (result == WHIT_OK)
        result = buffer_create(renderer->device, slots * turns * sizeof(struct gpu_passed),
                               BUFFER_STORAGE, "shadows so far", &brute->passed);
    if (result == WHIT_OK)
        renderer->scene_buffers.bytes += buffer_size(brute->found) + buffer_size(brute->passed);
    brute->bytes = renderer->scene_buffers.bytes - before;
    return result;
}

void brute_finish(struct brute_state *brute)
{
    pass_finish(&brute->closest);
    pass_finish(&brute->shadow);
    buffer_destroy(brute->runs);
    buffer_destroy(brute->found);
    buffer_destroy(brute->passed);
    free(brute->ranges);
    *brute = (struct brute_state){0};
}

/* ---- One sample ---- */

struct submission {
    struct renderer *renderer;
    const struct progress *progress;
    double start_ms, longest_ms;
    uint32_t turns; /* recorded so far */
};

/* `chunk`: whose camera rays begin; NULL: none do. */
static whit_result submission_begin(struct submission *s, const struct gpu_chunk *chunk)
{
    struct commands *commands = s->renderer->commands;
    s->start_ms = clock_ms();
    s->turns = 0;
    whit_result result = commands_begin(commands);
    if (result != WHIT_OK)
        return result;
    commands_fill(commands, s->renderer->pixel_buffers.status, 0, 4, 0);
    if (chunk)
        render_take_list(s->renderer, chunk);
    commands_barrier(commands);
    commands_span_begin(commands, "without trees");
    return WHIT_OK;
}

static whit_result submission_end(struct submission *s)
{
    whit_result result = render_finish_submission(s->renderer);
    double spent_ms = clock_ms() - s->start_ms;
    s->longest_ms = spent_ms > s->longest_ms ? spent_ms : s->longest_ms;
    return result;
}

static whit_result submission_next(struct submission *s)
{
    whit_result result = submission_end(s);
    if (result == WHIT_OK)
        result = render_stop_asked(s->renderer, s->progress);
    return result == WHIT_OK ? submission_begin(s, NULL) : result;
}

/* A dispatch of `pass` over all pixels of the chunk, or over those of the work list. */
static whit_result record(struct submission *s, const struct pass *pass,
                          const struct gpu_chunk *chunk, uint32_t list, uint32_t turns)
{
    struct commands *commands = s->renderer->commands;
    whit_result result = WHIT_OK;
    if (s->turns > 0 && s->turns + turns > RANGE_TURNS)
        result = submission_next(s);
    if (result != WHIT_OK)
        return result;
    s->turns += turns;
    commands_bind(commands, pass->pipeline, pass->sets[list]);
    commands_push(commands, chunk, sizeof *chunk);
    if (chunk->stacked)
        commands_dispatch_indirect(commands, s->renderer->pixel_buffers.work[list], 0);
    else
        commands_dispatch(commands, render_groups(chunk), 1, 1);
    commands_barrier(commands);
    ++s->renderer->stats.dispatches;
    return WHIT_OK;
}

static whit_result record_ranges(struct submission *s, const struct pass *pass,
                                 const struct gpu_chunk *chunk, uint32_t list)
{
    const struct brute_state *brute = &s->renderer->brute;
    struct gpu_chunk part = *chunk;
    whit_result result = WHIT_OK;
    for (uint32_t i = 0; result == WHIT_OK && i < brute->range_count; ++i) {
        part.begin = i == 0;
        part.first_run = brute->ranges[i].first_run;
        result = record(s, pass, &part, list, brute->ranges[i].turns);
    }
    return result;
}

/* One ray of each pixel: its hit, what passes from each light to it, its light. */
static whit_result record_ray(struct submission *s, const struct gpu_chunk *chunk, uint32_t list)
{
    struct renderer *renderer = s->renderer;
    const struct brute_state *brute = &renderer->brute;
    whit_result result = record_ranges(s, &brute->closest, chunk, list);
    uint32_t lights =
        renderer->effects.called[SCENE_EFFECT_SHADOWS] ? renderer->pose.light_count : 0;
    uint32_t turns = lights * renderer->frame.light_samples;
    struct gpu_chunk lit = *chunk;
    for (lit.light = 0; result == WHIT_OK && lit.light < turns; ++lit.light) {
        if (lights_take_turn(renderer, lit.light))
            result = record_ranges(s, &brute->shadow, &lit, list);
    }
    if (result != WHIT_OK)
        return result;
    render_clear_work(renderer, 1 - list);
    commands_barrier(renderer->commands);
    return record(s, &renderer->whitted, chunk, list, 1);
}

whit_result brute_sample(struct renderer *renderer, const struct gpu_chunk *chunk,
                         const struct progress *progress, double *longest_ms)
{
    struct submission s = {.renderer = renderer, .progress = progress};
    struct gpu_chunk ray = *chunk;
    struct gpu_work head = {.count = 1};
    whit_result result = WHIT_OK;
    for (uint32_t bounce = 0; result == WHIT_OK && head.count > 0; ++bounce) {
        uint32_t list = bounce % 2;
        ray.stacked = bounce > 0;
        result = submission_begin(&s, bounce == 0 ? chunk : NULL);
        if (result == WHIT_OK)
            result = record_ray(&s, &ray, list);
        if (result == WHIT_OK)
            result = submission_end(&s);
        if (!renderer->has_secondary)
            break;
        if (result == WHIT_OK)
            result = buffer_read(renderer->pixel_buffers.work[1 - list], 0, &head, sizeof head);
        if (result == WHIT_OK)
            result = render_stop_asked(renderer, progress);
    }
    *longest_ms = s.longest_ms > *longest_ms ? s.longest_ms : *longest_ms;
    return result;
}

/* ---- How long a picture will take ---- */

static whit_result time_crop(struct renderer *renderer, uint32_t first_block, uint32_t blocks,
                             double *spent_ms)
{
    /* Clock and cancellation as for the picture. */
    const struct progress progress = {.work_total = 1};
    struct gpu_chunk chunk = {.first_block = first_block,
                              .block_count = blocks,
                              .band_rows = renderer->pixel_buffers.band_rows,
                              .sample_xy = {0.5f, 0.5f},
                              .sample_weight = 1.0f};
    double start_ms = clock_ms(), longest_ms = 0.0;
    whit_result result = brute_sample(renderer, &chunk, &progress, &longest_ms);
    *spent_ms = clock_ms() - start_ms;
    return result == WHIT_OK ? render_stop_asked(renderer, &progress) : result;
}

static uint32_t crop_blocks(const struct renderer *renderer, uint32_t all)
{
    uint64_t tests = 0;
    for (uint32_t i = 0; i < renderer->brute.range_count; ++i)
        tests += renderer->brute.ranges[i].turns;
    uint64_t blocks = CROP_WORK / (tests + 1);
    uint64_t held = renderer->pixel_buffers.chunk_slots / RENDER_BLOCK_PIXELS;
    blocks = blocks < CROP_BLOCKS_MIN ? CROP_BLOCKS_MIN : blocks;
    blocks = blocks > CROP_BLOCKS_MAX ? CROP_BLOCKS_MAX : blocks;
    blocks = blocks > held ? held : blocks;
    return blocks > all ? all : (uint32_t)blocks;
}

whit_result brute_check_time(struct renderer *renderer)
{
    const struct render_params *params = &renderer->params;
    struct brute_state *brute = &renderer->brute;
    if (!renderer->accel->no_trees || brute->time_checked)
        return WHIT_OK;
    uint32_t across = (params->width + 7) / 8, down = renderer->pixel_buffers.band_rows / 8;
    uint32_t held = across * down, total = across * ((params->height + 7) / 8);
    uint32_t all = held < total ? held : total; /* of the first band */
    uint32_t blocks = crop_blocks(renderer, all), timed = 0;
    double spent_ms = 0.0, ignored_ms;
    /* The first dispatch of a pipeline may compile it. */
    whit_result result = time_crop(renderer, all / 2, 1, &ignored_ms);
    if (result != WHIT_OK)
        return result;
    for (uint32_t i = 0; i < CROPS && (i == 0 || spent_ms < ESTIMATE_MS); ++i) {
        /* The middle first, then on both sides of it. */
        static const uint32_t places[CROPS] = {4, 2, 6, 1, 7};
        uint32_t first = (uint32_t)((uint64_t)(all - blocks) * places[i] / 8);
        double crop_ms;
        result = time_crop(renderer, first, blocks, &crop_ms);
        if (result != WHIT_OK)
            return result;
        spent_ms += crop_ms;
        timed += blocks;
    }
    double estimate_s = spent_ms * 1e-3 / timed * total * params->samples;
    double limit_s = params->time_limit_s > 0.0 ? params->time_limit_s : LIMIT_DEFAULT_S;
    brute->time_checked = true;
    if (estimate_s <= limit_s)
        return WHIT_OK;
    brute->time_checked = false;
    log_error(&renderer->log,
              "without trees this picture would take about %.0f s (by %u of its %u blocks of 8x8 "
              "pixels), more than the limit of %g s: a higher time limit (--time-limit) allows it",
              estimate_s, timed, total, limit_s);
    return WHIT_ERROR_TIME_LIMIT;
}

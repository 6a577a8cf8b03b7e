/* The order of a picture: chunks of pixel blocks; for each sample of a chunk one dispatch of camera
   rays and, as long as a pixel has rays left, one dispatch a ray. A chunk's size follows measured
   time, so that no submission runs long. */
#include "render/render.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/clock.h"
#include "render/renderer.h"

enum {
    TILE_MIN = 16,
    TILE_MAX = 512,
    TILE_FIRST = 64,
    TILE_STACKED_MAX = 128, /* ray stacks cost memory; larger only when asked for */
    DEPTH_LARGEST = 255,    /* bounces of a ray have 8 bits */
    PASSES_FIRST = 8,
    PASSES_MAX = 64,
};
/* Ctrl+C must be obeyed within 0.2 s, and GPU watchdogs want less than a second. */
static const double SUBMISSION_TARGET_MS = 40.0;
static const double SUBMISSION_LIMIT_MS = 100.0;

whit_result status_check(struct renderer *renderer)
{
    uint32_t word = 0;
    whit_result result = buffer_read(renderer->pixel_buffers.status, 0, &word, sizeof word);
    if (result != WHIT_OK || word == 0)
        return result;
    const struct {
        uint32_t bit;
        const char *text;
    } reasons[] = {
        {STATUS_UNFINISHED_TRAVERSAL, "a traversal was cut short (the driver ends long loops)"},
        {STATUS_NODE_STACK_OVERFLOW, "the node stack overflowed"},
        {STATUS_RAY_STACK_OVERFLOW, "the ray stack overflowed"},
        {STATUS_NON_FINITE, "radiance is not finite"},
        {STATUS_MEDIUM_STACK_OVERFLOW, "a ray was in more media at once than its stack holds"},
        {STATUS_UNFINISHED_LOOP, "a loop over lights was cut short (the driver ends long loops)"},
    };
    for (size_t i = 0; i < sizeof reasons / sizeof *reasons; ++i) {
        if (word & reasons[i].bit)
            log_error(&renderer->log, "the result is not to be trusted: %s", reasons[i].text);
    }
    return WHIT_ERROR_STATUS;
}

static uint32_t blocks_across(uint32_t pixels)
{
    return (pixels + 7) / 8;
}

static whit_result check_params(const struct log *log, struct render_params *params)
{
    if (params->width == 0 && params->height == 0) {
        params->width = 640;
        params->height = 480;
    }
    if (params->samples == 0)
        params->samples = 1;
    if (params->width == 0 || params->height == 0 || params->width > 65535 ||
        params->height > 65535) {
        log_error(log, "size %ux%u: both sides must be 1..65535", params->width, params->height);
        return WHIT_ERROR_USAGE;
    }
    uint32_t n = params->samples;
    if (n != 1 && n != 4 && n != 16 && n != 64) {
        log_error(log, "%u samples a pixel: must be 1, 4, 16 or 64", n);
        return WHIT_ERROR_USAGE;
    }
    n = params->light_samples;
    if (n != 0 && n != 1 && n != 4 && n != 16 && n != 64) {
        log_error(log, "%u samples of an area light: must be 1, 4, 16 or 64", n);
        return WHIT_ERROR_USAGE;
    }
    if (params->tile_size && (params->tile_size < TILE_MIN || params->tile_size > TILE_MAX)) {
        log_error(log, "tile size %u: must be %d..%d", params->tile_size, TILE_MIN, TILE_MAX);
        return WHIT_ERROR_USAGE;
    }
    if (!(params->adaptive >= 0.0) || params->adaptive > 1.0) {
        log_error(log, "adaptive contrast %g: must be 0 (off) up to 1", params->adaptive);
        return WHIT_ERROR_USAGE;
    }
    if (params->adaptive > 0.0 && params->count) {
        log_error(log, "what rays cost is counted with 1, 4, 16 or 64 samples a pixel, not with "
                       "adaptive ones");
        return WHIT_ERROR_USAGE;
    }
    if (params->adaptive > 0.0)
        params->samples = 4; /* to begin with */
    if (params->depth > DEPTH_LARGEST) {
        log_error(log, "depth %u: must be 0..%d", params->depth, DEPTH_LARGEST);
        return WHIT_ERROR_USAGE;
    }
    return WHIT_OK;
}

whit_result frame_fill(struct renderer *renderer)
{
    struct gpu_frame *frame = &renderer->frame;
    const struct accel *accel = renderer->accel;
    const struct scene_environment *environment = &renderer->scene->environment;
    uint32_t kind;
    whit_result result =
        camera_frame(&renderer->log, &renderer->pose, renderer->params.camera,
                     renderer->params.width, renderer->params.height, frame, &kind);
    if (result != WHIT_OK)
        return result;
    /* Of all cameras only the one that is drawn counts. */
    renderer->effects.called[SCENE_EFFECT_ORTHOGRAPHIC] = kind == CAMERA_ORTHOGRAPHIC;
    renderer->effects.called[SCENE_EFFECT_LENS] = kind == CAMERA_LENS;
    renderer->effects.called[SCENE_EFFECT_PANORAMA] = kind == CAMERA_PANORAMA;
    for (int i = 0; i < 3; ++i) {
        frame->zenith[i] = environment->zenith[i] * environment->scale[i];
        frame->horizon[i] = environment->horizon[i] * environment->scale[i];
        frame->ground[i] = environment->ground[i] * environment->scale[i];
        frame->ambient[i] = renderer->scene->ambient[i];
    }
    frame->light_count = renderer->pose.light_count;
    frame->light_samples = lights_samples(renderer);
    frame->environment_size = renderer->scene_buffers.environment_size;
    frame->root = accel->instance_root;
    frame->shade_base = 0;
    if (accel->flat) {
        frame->root = accel->meshes[0].root;
    } else if (accel->single_identity) {
        const struct accel_mesh *mesh = &accel->meshes[renderer->scene->instances[0].mesh];
        frame->root = mesh->root;
        frame->shade_base = mesh->shade_base;
    }
    frame->depth = renderer->params.depth;
    double bailout = renderer->params.bailout;
    frame->bailout = bailout == 0.0  ? (float)WHIT_BAILOUT_DEFAULT
                     : bailout < 0.0 ? FLT_MIN
                                     : (float)bailout;
    frame->stack_size = renderer->pixel_buffers.stack_size;
    return media_frame(renderer);
}

/* Rays that wait when one ray leaves up to `children` others, depth first. */
static uint32_t ray_stack_size(uint32_t depth, uint32_t children)
{
    return depth * (children - 1) + 1;
}

static uint32_t largest_tile(const struct renderer *renderer)
{
    const struct render_params *params = &renderer->params;
    uint32_t tile = params->tile_size         ? params->tile_size
                    : renderer->has_secondary ? TILE_STACKED_MAX
                                              : TILE_MAX;
    if (renderer->accel->no_trees && !params->tile_size)
        tile = TILE_STACKED_MAX;
    uint64_t limit = device_get_info(renderer->device)->max_storage_range_bytes;
    uint64_t slot_bytes = 0;
    if (renderer->has_secondary)
        slot_bytes = sizeof(struct gpu_stacked_ray) * renderer->pixel_buffers.stack_size;
    uint64_t passed_bytes = sizeof(struct gpu_passed) * lights_turns(renderer);
    if (renderer->accel->no_trees && passed_bytes > slot_bytes)
        slot_bytes = passed_bytes;
    while (tile > TILE_MIN && (uint64_t)tile * tile * slot_bytes > limit)
        tile /= 2;
    return tile;
}

static whit_result create_pixel_buffers(struct renderer *renderer)
{
    struct pixel_buffers *p = &renderer->pixel_buffers;
    struct device *device = renderer->device;
    uint32_t width = renderer->params.width;
    uint64_t limit = device_get_info(device)->max_storage_range_bytes;
    uint64_t rows = limit / ((uint64_t)width * sizeof(struct gpu_counts)) / 8 * 8;
    uint32_t height = blocks_across(renderer->params.height) * 8;
    p->band_rows = rows < height ? (uint32_t)rows : height;
    if (p->band_rows == 0) {
        log_error(&renderer->log, "width %u is over what one buffer of the device holds", width);
        return WHIT_ERROR_DEVICE;
    }
    bool blend = renderer->effects.called[SCENE_EFFECT_CUTOUTS] ||
                 renderer->effects.called[SCENE_EFFECT_CATCHERS];
    p->stack_size = ray_stack_size(renderer->params.depth, blend ? 3 : 2);
    uint32_t tile = largest_tile(renderer);
    uint64_t frame_slots = (uint64_t)blocks_across(width) * (p->band_rows / 8) * 64;
    uint64_t slots = (uint64_t)tile * tile;
    p->chunk_slots = (uint32_t)(slots < frame_slots ? slots : frame_slots);
    uint64_t pixels = (uint64_t)width * p->band_rows;
    /* What nothing is bound to has no bytes, and is not created. */
    bool adaptive = renderer->params.adaptive > 0.0;
    bool lists = renderer->has_secondary || adaptive || renderer->accel->no_trees;
    uint64_t list_bytes = lists ? 16 + (uint64_t)p->chunk_slots * 4 : 0;
    uint64_t stacked = renderer->has_secondary ? (uint64_t)p->chunk_slots * p->stack_size : 0;
    whit_result result = WHIT_OK;
    const struct {
        struct buffer **buffer;
        uint64_t bytes;
        uint32_t uses;
        const char *name;
    } all[] = {
        {&p->pixels, pixels * 16, BUFFER_STORAGE | BUFFER_HOST, "pixels"},
        {&p->ids, pixels * 8, BUFFER_STORAGE | BUFFER_HOST, "ids"},
        {&p->counts, pixels * sizeof(struct gpu_counts), BUFFER_STORAGE | BUFFER_HOST, "counts"},
        {&p->status, 16, BUFFER_STORAGE | BUFFER_HOST, "status"},
        {&p->work[0], list_bytes, BUFFER_STORAGE | BUFFER_INDIRECT | BUFFER_HOST, "work list 0"},
        {&p->work[1], list_bytes, BUFFER_STORAGE | BUFFER_INDIRECT | BUFFER_HOST, "work list 1"},
        {&p->work_head, lists ? 16 : 0, BUFFER_STORAGE | BUFFER_HOST, "empty work list"},
        {&p->listed, adaptive ? list_bytes : 0, BUFFER_STORAGE | BUFFER_HOST, "listed pixels"},
        {&p->ray_stacks, stacked * sizeof(struct gpu_stacked_ray), BUFFER_STORAGE, "ray stacks"},
        {&p->ray_media,
         renderer->effects.called[SCENE_EFFECT_MEDIA] ? stacked * sizeof(struct gpu_media) : 0,
         BUFFER_STORAGE, "ray media"},
    };
    for (size_t i = 0; result == WHIT_OK && i < sizeof all / sizeof *all; ++i) {
        if (all[i].bytes == 0)
            continue;
        result = buffer_create(device, all[i].bytes, all[i].uses, all[i].name, all[i].buffer);
        if (result == WHIT_OK)
            renderer->scene_buffers.bytes += all[i].bytes;
    }
    if (result == WHIT_OK)
        result = costs_create(renderer);
    const struct gpu_work head = {.groups_x = 0, .groups_y = 1, .groups_z = 1, .count = 0};
    if (result == WHIT_OK && lists)
        result = buffer_write(p->work_head, 0, &head, sizeof head);
    return result;
}

static void pixel_buffers_finish(struct pixel_buffers *p)
{
    struct buffer *all[] = {p->pixels,  p->ids,       p->counts,    p->status,
                            p->work[0], p->work[1],   p->work_head, p->ray_stacks,
                            p->costs,   p->ray_media, p->listed};
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i)
        buffer_destroy(all[i]);
    *p = (struct pixel_buffers){0};
}

static bool calls_for_secondary(const struct renderer *renderer)
{
    const bool *called = renderer->effects.called;
    return renderer->params.depth > 0 &&
           (called[SCENE_EFFECT_REFLECTION] || called[SCENE_EFFECT_REFRACTION] ||
            called[SCENE_EFFECT_CUTOUTS] || called[SCENE_EFFECT_CATCHERS]);
}

static whit_result create_parts(struct renderer *renderer)
{
    double start_ms = clock_ms();
    renderer->has_secondary = calls_for_secondary(renderer);
    renderer->node_stack_size = accel_stack_size(renderer->accel);
    renderer->single_identity = renderer->accel->single_identity;
    whit_result result = create_pixel_buffers(renderer);
    if (result == WHIT_OK)
        result = upload_scene(renderer);
    if (result == WHIT_OK)
        result = frame_fill(renderer);
    if (result == WHIT_OK)
        result = upload_words(renderer, &renderer->frame, sizeof renderer->frame, BUFFER_STORAGE,
                              "frame", &renderer->scene_buffers.frame);
    if (result == WHIT_OK)
        result = brute_create(renderer);
    renderer->stats.upload_ms = clock_ms() - start_ms;
    if (result == WHIT_OK)
        result = commands_create(renderer->device, "render", &renderer->commands);
    renderer->stats.texel_loads = renderer->scene_buffers.texel_loads;
    renderer->stats.device_bytes = renderer->scene_buffers.bytes;
    return result;
}

/* Renderers that only trace batches never need the large kernel. */
static whit_result compile(struct renderer *renderer)
{
    bool beside = renderer->params.compile_beside && !renderer->accel->no_trees;
    if (renderer->whitted.pipeline && !renderer->beside.general)
        return WHIT_OK;
    double start_ms = clock_ms();
    whit_result result = beside ? beside_prepare(renderer) : variant_create_whitted(renderer);
    if (result == WHIT_OK) {
        struct pipeline_info info;
        pipeline_get_info(renderer->whitted.pipeline, &info);
        renderer->stats.kernel_instructions = info.instructions;
        renderer->stats.general = renderer->beside.general;
    } else {
        passes_finish(renderer);
    }
    renderer->stats.compile_ms = clock_ms() - start_ms;
    return result;
}

whit_result renderer_create(const struct log *log, struct device *device, struct accel *accel,
                            const struct render_params *params, struct renderer **out)
{
    *out = NULL;
    struct renderer *renderer = calloc(1, sizeof *renderer);
    if (!renderer)
        return WHIT_ERROR_MEMORY;
    renderer->log = *log;
    renderer->create_ms = clock_ms();
    renderer->device = device;
    renderer->accel = accel;
    renderer->scene = accel->scene;
    if (params)
        renderer->params = *params;
    scene_effects_scan(renderer->scene, &renderer->effects);
    effects_choose(&renderer->params, &renderer->effects);
    whit_result result = check_params(log, &renderer->params);
    if (renderer->scene->pictures_dropped) {
        log_error(log, "%s: its textures were dropped, no further renderer can be made from it",
                  renderer->scene->name);
        result = WHIT_ERROR_USAGE;
    }
    if (result == WHIT_OK)
        result = scene_pose_init(renderer->scene, renderer->params.time_s, &renderer->pose);
    if (result == WHIT_OK)
        result = accel_pose(accel, &renderer->pose);
    if (result == WHIT_OK)
        result = create_parts(renderer);
    if (result == WHIT_OK && renderer->params.compile_beside)
        result = compile(renderer);
    if (result != WHIT_OK) {
        renderer_destroy(renderer);
        return result;
    }
    *out = renderer;
    return WHIT_OK;
}

void renderer_destroy(struct renderer *renderer)
{
    if (!renderer)
        return;
    commands_destroy(renderer->commands);
    passes_finish(renderer);
    beside_finish(renderer);
    trace_finish(&renderer->trace);
    brute_finish(&renderer->brute);
    pixel_buffers_finish(&renderer->pixel_buffers);
    costs_clear(renderer);
    upload_finish(&renderer->scene_buffers);
    scene_pose_finish(&renderer->pose);
    image_finish(&renderer->color);
    image_finish(&renderer->ids);
    free(renderer);
}

/* How much of the picture is done, 0..1. */
static double picture_share(const struct progress *progress)
{
    return progress->before +
           progress->share * (double)progress->work_done / (double)progress->work_total;
}

static void report_progress(const struct renderer *renderer, const struct progress *progress)
{
    if (renderer->params.progress)
        renderer->params.progress(renderer->params.progress_user, picture_share(progress));
}

whit_result render_stop_asked(const struct renderer *renderer, const struct progress *progress)
{
    const struct render_params *params = &renderer->params;
    if (params->cancel && *params->cancel)
        return WHIT_ERROR_CANCELLED;
    if (params->time_limit_s > 0.0 &&
        clock_ms() - renderer->create_ms > params->time_limit_s * 1e3) {
        log_error(&renderer->log, "time limit of %g s passed with %.0f %% of the picture done",
                  params->time_limit_s, 100.0 * picture_share(progress));
        return WHIT_ERROR_TIME_LIMIT;
    }
    return WHIT_OK;
}

static whit_result submit(struct renderer *renderer)
{
    whit_result result = commands_submit(renderer->commands);
    if (result == WHIT_OK)
        result = commands_wait(renderer->commands, -1.0);
    if (result != WHIT_OK)
        return result;
    double device_ms = commands_span_ms(renderer->commands, 0);
    if (device_ms < 0.0 || renderer->stats.render_device_ms < 0.0)
        renderer->stats.render_device_ms = -1.0;
    else
        renderer->stats.render_device_ms += device_ms;
    return status_check(renderer);
}

void render_clear_work(struct renderer *renderer, uint32_t list)
{
    const struct pixel_buffers *p = &renderer->pixel_buffers;
    if (p->work[list])
        commands_copy(renderer->commands, p->work_head, 0, p->work[list], 0,
                      sizeof(struct gpu_work));
}

void render_take_list(struct renderer *renderer, const struct gpu_chunk *chunk)
{
    const struct pixel_buffers *p = &renderer->pixel_buffers;
    if (chunk->listed > 0)
        commands_copy(renderer->commands, p->listed, 0, p->work[0], 0,
                      sizeof(struct gpu_work) + (uint64_t)chunk->listed * sizeof(uint32_t));
}

uint32_t render_groups(const struct gpu_chunk *chunk)
{
    uint32_t slots = chunk->listed ? chunk->listed : chunk->block_count * RENDER_BLOCK_PIXELS;
    return (slots + RENDER_GROUP_SIZE - 1) / RENDER_GROUP_SIZE;
}

bool render_slot_pixel(const struct renderer *renderer, uint32_t block, uint32_t i, uint32_t *x,
                       uint32_t *y)
{
    uint32_t across = blocks_across(renderer->params.width);
    *x = block % across * 8 + ((i & 3) | (i >> 1 & 4));
    *y = block / across * 8 + ((i >> 2 & 1) | (i >> 3 & 6));
    return *x < renderer->params.width && *y < renderer->params.height;
}

/* Camera rays; pixels with rays left go to list 1. */
static whit_result record_primary(struct renderer *renderer, const struct gpu_chunk *chunk)
{
    struct commands *commands = renderer->commands;
    whit_result result = commands_begin(commands);
    if (result != WHIT_OK)
        return result;
    commands_fill(commands, renderer->pixel_buffers.status, 0, 4, 0);
    render_clear_work(renderer, 1);
    render_take_list(renderer, chunk);
    commands_barrier(commands);
    commands_span_begin(commands, "sample");
    commands_bind(commands, renderer->whitted.pipeline, renderer->whitted.sets[0]);
    commands_push(commands, chunk, sizeof *chunk);
    commands_dispatch(commands, render_groups(chunk), 1, 1);
    ++renderer->stats.dispatches;
    return WHIT_OK;
}

/* One ray more of each listed pixel, `passes` times: pass i reads list (i + 1) % 2 and fills the
   other. */
static void record_passes(struct renderer *renderer, const struct gpu_chunk *chunk, uint32_t first,
                          uint32_t passes)
{
    struct commands *commands = renderer->commands;
    struct gpu_chunk stacked = *chunk;
    stacked.stacked = 1;
    for (uint32_t i = first; i < first + passes; ++i) {
        uint32_t in = (i + 1) % 2;
        commands_barrier(commands);
        render_clear_work(renderer, 1 - in);
        commands_barrier(commands);
        commands_bind(commands, renderer->whitted.pipeline, renderer->whitted.sets[in]);
        commands_push(commands, &stacked, sizeof stacked);
        commands_dispatch_indirect(commands, renderer->pixel_buffers.work[in], 0);
        ++renderer->stats.dispatches;
    }
}

whit_result render_finish_submission(struct renderer *renderer)
{
    commands_span_end(renderer->commands);
    commands_barrier(renderer->commands);
    return submit(renderer);
}

/* All rays of one sample of one chunk. *longest_ms: of its submissions. */
static whit_result render_sample(struct renderer *renderer, const struct gpu_chunk *chunk,
                                 const struct progress *progress, double *longest_ms)
{
    uint32_t passes = renderer->has_secondary ? PASSES_FIRST : 0, first = 0;
    double start_ms = clock_ms();
    whit_result result = record_primary(renderer, chunk);
    if (result == WHIT_OK) {
        record_passes(renderer, chunk, first, passes);
        result = render_finish_submission(renderer);
    }
    for (;;) {
        double spent_ms = clock_ms() - start_ms;
        *longest_ms = spent_ms > *longest_ms ? spent_ms : *longest_ms;
        if (result != WHIT_OK || passes == 0)
            return result;
        first += passes;
        struct gpu_work head;
        result = buffer_read(renderer->pixel_buffers.work[(first + 1) % 2], 0, &head, sizeof head);
        if (result != WHIT_OK || head.count == 0)
            return result;
        result = render_stop_asked(renderer, progress);
        if (result != WHIT_OK)
            return result;
        if (spent_ms < SUBMISSION_TARGET_MS && passes < PASSES_MAX)
            passes *= 2;
        else if (spent_ms > SUBMISSION_LIMIT_MS && passes > 2)
            passes /= 2;
        start_ms = clock_ms();
        result = commands_begin(renderer->commands);
        if (result != WHIT_OK)
            return result;
        commands_span_begin(renderer->commands, "bounces");
        record_passes(renderer, chunk, first, passes);
        result = render_finish_submission(renderer);
    }
}

static void adapt_tile(const struct renderer *renderer, struct progress *progress, double spent_ms)
{
    uint64_t slots = (uint64_t)progress->tile * progress->tile;
    if (renderer->params.tile_size)
        return;
    if (spent_ms > SUBMISSION_LIMIT_MS && progress->tile > TILE_MIN)
        progress->tile /= 2;
    else if (spent_ms < SUBMISSION_TARGET_MS / 4 &&
             slots * 4 <= renderer->pixel_buffers.chunk_slots)
        progress->tile *= 2;
}

static whit_result render_chunk(struct renderer *renderer, struct gpu_chunk *chunk,
                                struct progress *progress)
{
    uint32_t samples = progress->samples;
    double longest_ms = 0.0;
    for (uint32_t s = 0; s < samples; ++s) {
        whit_result result = render_stop_asked(renderer, progress);
        if (result != WHIT_OK)
            return result;
        chunk->sample_index = s;
        chunk->sample_weight = 1.0f / (float)samples;
        camera_sample(&renderer->frame, s, samples, chunk);
        result = renderer->accel->no_trees ? brute_sample(renderer, chunk, progress, &longest_ms)
                                           : render_sample(renderer, chunk, progress, &longest_ms);
        if (result == WHIT_OK)
            result = costs_add(renderer, chunk);
        if (result != WHIT_OK)
            return result;
        progress->work_done += chunk->block_count;
        report_progress(renderer, progress);
    }
    ++renderer->stats.tiles;
    adapt_tile(renderer, progress, longest_ms);
    return WHIT_OK;
}

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

enum { SLICE = 4096 }; /* pixels that are read at once */

/* Sums what the kernel counted for `count` pixels of the band, of which `first` is the first one's
   index in the picture, slice by slice. */
static whit_result add_counts(struct renderer *renderer, const struct progress *progress,
                              size_t first, size_t count)
{
    struct gpu_counts counts[SLICE];
    for (size_t at = 0; at < count; at += SLICE) {
        size_t n = count - at < SLICE ? count - at : SLICE;
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

/* A picture of one band and one pass stays on the device until it is asked for. */
static bool stays_on_device(const struct renderer *renderer)
{
    return renderer->pixel_buffers.band_rows >= renderer->params.height &&
           !(renderer->params.adaptive > 0.0);
}

static whit_result read_pixels(const struct renderer *renderer, uint32_t rows, float *pixels)
{
    return buffer_read(renderer->pixel_buffers.pixels, 0, pixels,
                       (uint64_t)renderer->params.width * rows * 4 * sizeof *pixels);
}

static whit_result read_ids(const struct renderer *renderer, uint32_t rows, uint32_t *words)
{
    return buffer_read(renderer->pixel_buffers.ids, 0, words,
                       (uint64_t)renderer->params.width * rows * 2 * sizeof *words);
}

/* Those that the pass drew, of `count` pixels of the band, into the picture from pixel `first` on.
 */
static whit_result read_listed(struct renderer *renderer, const struct progress *progress,
                               size_t first, size_t count)
{
    float pixels[SLICE][4];
    for (size_t at = 0; at < count; at += SLICE) {
        size_t n = count - at < SLICE ? count - at : SLICE;
        whit_result result = buffer_read(renderer->pixel_buffers.pixels, at * sizeof *pixels,
                                         pixels, n * sizeof *pixels);
        if (result != WHIT_OK)
            return result;
        for (size_t i = 0; i < n; ++i) {
            if (adaptive_draws(progress, first + at + i))
                memcpy(&renderer->color.pixels[4 * (first + at + i)], pixels[i], sizeof pixels[i]);
        }
    }
    return WHIT_OK;
}

/* What the device holds of a finished band, into the picture and the statistics. Ids are those of
   the first pass. */
static whit_result read_band(struct renderer *renderer, const struct progress *progress,
                             uint32_t band_y, uint32_t rows)
{
    size_t first = (size_t)renderer->params.width * band_y;
    size_t count = (size_t)renderer->params.width * rows;
    whit_result result = WHIT_OK;
    if (progress->listed) {
        result = read_listed(renderer, progress, first, count);
    } else if (!stays_on_device(renderer)) {
        result = read_pixels(renderer, rows, &renderer->color.pixels[4 * first]);
        if (result == WHIT_OK)
            result = read_ids(renderer, rows, &renderer->ids.words[2 * first]);
    }
    return result == WHIT_OK ? add_counts(renderer, progress, first, count) : result;
}

/* All samples of a chunk in this pass; of the pixels that it lists, when it does. */
static whit_result pass_chunk(struct renderer *renderer, struct gpu_chunk *chunk,
                              struct progress *progress)
{
    whit_result result = WHIT_OK;
    if (progress->listed)
        result = adaptive_list(renderer, progress, chunk);
    if (result != WHIT_OK)
        return result;
    if (!progress->listed || chunk->listed > 0)
        return render_chunk(renderer, chunk, progress);
    progress->work_done += (uint64_t)chunk->block_count * progress->samples;
    report_progress(renderer, progress);
    return render_stop_asked(renderer, progress);
}

static whit_result render_band(struct renderer *renderer, uint32_t band_y,
                               struct progress *progress)
{
    const struct render_params *params = &renderer->params;
    uint32_t left = params->height - band_y;
    uint32_t rows =
        left < renderer->pixel_buffers.band_rows ? left : renderer->pixel_buffers.band_rows;
    uint32_t across = blocks_across(params->width);
    uint32_t block = band_y / 8 * across, end = block + blocks_across(rows) * across;
    while (block < end) {
        uint32_t blocks = progress->tile * progress->tile / RENDER_BLOCK_PIXELS;
        uint32_t held = renderer->pixel_buffers.chunk_slots / RENDER_BLOCK_PIXELS;
        blocks = blocks < held ? blocks : held;
        struct gpu_chunk chunk = {.first_block = block,
                                  .block_count = end - block < blocks ? end - block : blocks,
                                  .band_y = band_y,
                                  .band_rows = rows};
        whit_result result = pass_chunk(renderer, &chunk, progress);
        if (result != WHIT_OK)
            return result;
        block += chunk.block_count;
        renderer->stats.tile_size = progress->tile;
    }
    return read_band(renderer, progress, band_y, rows);
}

/* `samples` for all pixels, or for those that progress->levels gives so many. */
static whit_result render_pass(struct renderer *renderer, uint32_t samples,
                               struct progress *progress)
{
    const struct render_params *params = &renderer->params;
    whit_result result = WHIT_OK;
    progress->samples = samples;
    progress->work_done = 0;
    progress->work_total =
        (uint64_t)blocks_across(params->width) * blocks_across(params->height) * samples;
    for (uint32_t y = 0; result == WHIT_OK && y < params->height;
         y += renderer->pixel_buffers.band_rows)
        result = render_band(renderer, y, progress);
    progress->before += progress->share;
    progress->work_done = 0;
    return result;
}

/* 4 samples for all pixels; 16 for those that then differ from a neighbour; 64 for those that still
   do. Only pictures as a whole tell who differs, so passes are over all bands. */
static whit_result render_adaptive(struct renderer *renderer, struct progress *progress)
{
    const struct render_params *params = &renderer->params;
    size_t pixels = (size_t)params->width * params->height;
    progress->levels = array_alloc(pixels, sizeof *progress->levels);
    if (!progress->levels) {
        log_error(&renderer->log, "out of memory for the samples of pixels");
        return WHIT_ERROR_MEMORY;
    }
    memset(progress->levels, 1, pixels);
    progress->share = 1.0 / 3.0;
    whit_result result = render_pass(renderer, 4, progress);
    for (uint8_t level = 2; result == WHIT_OK && level <= 3; ++level) {
        uint64_t marked =
            adaptive_mark(&renderer->color, params->adaptive, level, progress->levels);
        renderer->stats.rays_primary += marked << (2 * level);
        progress->listed = true;
        if (marked > 0)
            result = render_pass(renderer, 1u << (2 * level), progress);
        else
            progress->before += progress->share;
    }
    report_progress(renderer, progress);
    for (size_t i = 0; i < pixels; ++i)
        ++renderer->stats.pixels_by_samples[progress->levels[i]];
    free(progress->levels);
    progress->levels = NULL;
    return result;
}

static whit_result render_picture(struct renderer *renderer, struct progress *progress)
{
    const struct render_params *params = &renderer->params;
    uint64_t pixels = (uint64_t)params->width * params->height;
    renderer->stats.rays_primary = pixels * params->samples;
    if (params->adaptive > 0.0)
        return render_adaptive(renderer, progress);
    uint32_t level = 0;
    while (1u << (2 * level) < params->samples)
        ++level;
    renderer->stats.pixels_by_samples[level] = pixels;
    return render_pass(renderer, params->samples, progress);
}

static void clear_stats(struct render_stats *stats)
{
    *stats = (struct render_stats){.upload_ms = stats->upload_ms,
                                   .compile_ms = stats->compile_ms,
                                   .device_bytes = stats->device_bytes,
                                   .kernel_instructions = stats->kernel_instructions,
                                   .general = stats->general,
                                   .texel_loads = stats->texel_loads};
}

whit_result renderer_render(struct renderer *renderer)
{
    const struct render_params *params = &renderer->params;
    renderer->rendered = false;
    if (renderer->between_times) {
        log_error(&renderer->log, "its time could not be set, so there is nothing to render");
        return WHIT_ERROR_USAGE;
    }
    image_finish(&renderer->color);
    image_finish(&renderer->ids);
    costs_clear(renderer);
    whit_result result = compile(renderer);
    if (result == WHIT_OK)
        result = brute_check_time(renderer);
    if (result == WHIT_OK && !stays_on_device(renderer))
        result = image_init(&renderer->color, params->width, params->height, 4, false);
    if (result == WHIT_OK && !stays_on_device(renderer))
        result = image_init(&renderer->ids, params->width, params->height, 2, true);
    clear_stats(&renderer->stats);
    uint32_t largest = (uint32_t)sqrt((double)renderer->pixel_buffers.chunk_slots);
    struct progress progress = {
        .start_ms = clock_ms(),
        .tile = params->tile_size                             ? params->tile_size
                : renderer->accel->no_trees                   ? TILE_MIN
                : largest < TILE_FIRST && largest >= TILE_MIN ? largest
                                                              : TILE_FIRST,
        .share = 1.0,
    };
    if (result == WHIT_OK)
        result = render_picture(renderer, &progress);
    renderer->stats.render_ms = clock_ms() - progress.start_ms;
    renderer->rendered = result == WHIT_OK;
    return result;
}

static whit_result begin_read(const struct renderer *renderer, uint32_t channels, bool integers,
                              struct image *out)
{
    if (!renderer->rendered) {
        log_error(&renderer->log, "no picture was rendered yet");
        return WHIT_ERROR_USAGE;
    }
    return image_init(out, renderer->params.width, renderer->params.height, channels, integers);
}

whit_result renderer_read_color(struct renderer *renderer, struct image *out)
{
    whit_result result = begin_read(renderer, 4, false, out);
    if (result != WHIT_OK)
        return result;
    if (stays_on_device(renderer))
        return read_pixels(renderer, out->height, out->pixels);
    memcpy(out->pixels, renderer->color.pixels,
           (size_t)out->width * out->height * 4 * sizeof(float));
    return WHIT_OK;
}

whit_result renderer_read_ids(struct renderer *renderer, struct image *out)
{
    whit_result result = begin_read(renderer, 2, true, out);
    if (result != WHIT_OK)
        return result;
    if (stays_on_device(renderer))
        return read_ids(renderer, out->height, out->words);
    memcpy(out->words, renderer->ids.words,
           (size_t)out->width * out->height * 2 * sizeof(uint32_t));
    return WHIT_OK;
}

void renderer_get_stats(const struct renderer *renderer, struct render_stats *stats)
{
    *stats = renderer->stats;
    stats->bailout_bound = renderer->rendered ? bailout_bound(renderer) : -1.0;
}

/* The order of a picture: tiles of pixel blocks, each sample of a tile in stages (stages.c). The
   size of tiles follows measured time (adapt_tile), so that no submission runs long. */
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/clock.h"
#include "base/text.h"
#include "device/buffer.h"
#include "device/commands.h"
#include "render/adaptive_samples.h"
#include "render/costs.h"
#include "render/hooks.h"
#include "render/lights.h"
#include "render/material_shares.h"
#include "render/pixels.h"
#include "render/readback.h"
#include "render/renderer.h"
#include "render/reuse.h"
#include "render/stages.h"
#include "render/steps.h"
#include "render/tiles.h"
#include "render/views.h"

enum { TILE_FIRST_CPU = 128, TILE_FIRST = 192 };
/* Ctrl+C must be obeyed within 0.2 s, and GPU watchdogs allow less than a second. */
static const double SUBMISSION_LIMIT_MS = 100.0;

/* Describes which pixels drawn so far are not finite. It adds no pixels if none is: then a ray with
   a weight of NaN was lost. */
static void describe_non_finite(const struct target *target, char *text, size_t text_bytes)
{
    uint32_t x, y, count, stride = views_stride(target->renderer);
    char view[32] = "";
    if (readback_non_finite(target, &x, &y, &count) == WHIT_OK && count > 0) {
        if (target->renderer->views.count) {
            snprintf(view, sizeof view, " of view %u", y / stride);
            y %= stride;
        }
        text_add(text, text_bytes, ": in %u pixel%s so far, the first at %u,%u%s", count,
                 count == 1 ? "" : "s", x, y, view);
    }
    hooks_describe_file(target, text, text_bytes);
}

whit_result status_check(struct target *target, bool traces)
{
    uint32_t word = 0;
    whit_result result = buffer_read(target->buffers.status, 0, &word, sizeof word);
    target->stages.full = (word & STATUS_QUEUE_FULL) != 0;
    target->stages.cut = target->stages.may_cut && (word & STATUS_UNFINISHED) != 0;
    word &= ~STATUS_QUEUE_FULL;
    if (result != WHIT_OK || word == 0 || target->stages.cut)
        return result;
    const struct {
        uint32_t bit;
        const char *text;
        void (*describe)(const struct target *target, char *text, size_t text_bytes);
    } reasons[] = {
        {STATUS_UNFINISHED_TRAVERSAL,
         traces ? "a traversal was cut short (the driver ends long loops; --on cpu ends none)"
                : "a traversal was cut short (the driver ends long loops)",
         NULL},
        {STATUS_NODE_STACK_OVERFLOW, "the node stack overflowed", NULL},
        {STATUS_NON_FINITE, "radiance is not finite", describe_non_finite},
        {STATUS_MEDIUM_STACK_OVERFLOW, "a ray was in more media at once than its stack holds",
         NULL},
        {STATUS_UNFINISHED_LOOP, "a loop over lights was cut short (the driver ends long loops)",
         NULL},
        {STATUS_FUEL,
         "all loops in one call of the shader took more iterations together than it may",
         hooks_describe_fuel},
        {STATUS_CUT_LOOPS,
         "loops of the shader, with whit's own in trace(), visible() and the kernel "
         "around it, took more iterations than the driver allows all loops of a "
         "kernel together (65,535 on lavapipe)",
         hooks_describe_loops},
        {STATUS_SHAPE, "the answer for the shader's shape is wrong", hooks_describe_shape},
    };
    char text[2048] = "";
    uint32_t places = word & (STATUS_FUEL | STATUS_SHAPE);
    /* Only the cause is told: what loops that were cut short have made follows from it. */
    if (word & (STATUS_FUEL | STATUS_CUT_LOOPS))
        word &= ~STATUS_UNFINISHED;
    if (word & STATUS_CUT_LOOPS)
        word &= ~STATUS_SHAPE;
    if (word & STATUS_FUEL)
        word &= ~STATUS_CUT_LOOPS;
    for (size_t i = 0; i < sizeof reasons / sizeof *reasons; ++i) {
        char detail[768] = "";
        if (!(word & reasons[i].bit))
            continue;
        if (reasons[i].describe)
            reasons[i].describe(target, detail, sizeof detail);
        text_add(text, sizeof text, "%s%s%s", text[0] ? "; " : "", reasons[i].text, detail);
    }
    if (places) /* or the next picture would name the same place */
        result = hooks_clear_status(target);
    log_error(&target->renderer->log, "the result is not to be trusted: %s", text);
    return result == WHIT_OK ? WHIT_ERROR_STATUS : result;
}

/* The count (status_waits) is the second word of the status buffer. */
whit_result deferred_clear(struct target *target)
{
    const uint32_t none = 0;
    return buffer_write(target->buffers.status, sizeof none, &none, sizeof none);
}

whit_result deferred_read(const struct target *target, uint32_t *count)
{
    return buffer_read(target->buffers.status, sizeof *count, count, sizeof *count);
}

/* How much of the picture is done, 0..1. */
static double picture_share(const struct progress *progress)
{
    return progress->before +
           progress->share * (double)progress->work_done / (double)progress->work_total;
}

static void report_progress(struct renderer *renderer, const struct progress *progress)
{
    renderer->picture.stats.render_ms = clock_ms() - progress->start_ms;
    if (renderer->params.progress)
        renderer->params.progress(renderer->params.progress_user, picture_share(progress));
}

whit_result render_stop_due(const struct renderer *renderer)
{
    const whit_renderer_params *params = &renderer->params;
    if (params->cancel && *params->cancel)
        return WHIT_ERROR_CANCELLED;
    bool late =
        params->time_limit_s > 0.0 && clock_ms() - renderer->create_ms > params->time_limit_s * 1e3;
    return late ? WHIT_ERROR_TIME_LIMIT : WHIT_OK;
}

whit_result render_stop_asked(const struct renderer *renderer, const struct progress *progress)
{
    whit_result result = render_stop_due(renderer);
    if (result == WHIT_ERROR_TIME_LIMIT)
        log_error(&renderer->log, "the time limit passed with %.0f %% of the picture done",
                  100.0 * picture_share(progress));
    return result;
}

void render_clear_deferred(struct renderer *renderer, struct buffer *deferred)
{
    if (!deferred)
        return;
    commands_fill(renderer->commands, deferred, offsetof(struct gpu_work, groups_x), 4, 0);
    commands_fill(renderer->commands, deferred, offsetof(struct gpu_work, groups_y), 8, 1);
    commands_fill(renderer->commands, deferred, offsetof(struct gpu_work, count), 4, 0);
}

void render_take_deferred(struct commands *commands, struct pipeline *pipeline,
                          struct binding_set *set, struct buffer *deferred, const void *push,
                          uint32_t push_bytes)
{
    commands_barrier(commands);
    commands_bind(commands, pipeline, set);
    commands_push(commands, push, push_bytes);
    commands_dispatch_indirect(commands, deferred, 0);
}

void render_push_chunk(struct renderer *renderer, struct gpu_chunk *chunk)
{
    chunk->block_row = chunk->first_block / chunk->blocks_x;
    commands_push(renderer->commands, chunk, sizeof *chunk);
}

uint32_t render_slots(const struct gpu_chunk *chunk)
{
    uint32_t slots = chunk->block_count * RENDER_BLOCK_PIXELS;
    uint32_t left = chunk->listed - chunk->first_block * RENDER_BLOCK_PIXELS;
    return chunk->listed && left < slots ? left : slots;
}

uint32_t render_groups(const struct gpu_chunk *chunk)
{
    return (render_slots(chunk) + RENDER_GROUP_SIZE - 1) / RENDER_GROUP_SIZE;
}

bool render_slot_pixel(const struct renderer *renderer, uint32_t block, uint32_t i, uint32_t *x,
                       uint32_t *y)
{
    uint32_t across = pixels_blocks_across(renderer->params.width);
    *x = block % across * 8 + ((i & 3) | (i >> 1 & 4));
    *y = block / across * 8 + ((i >> 2 & 1) | (i >> 3 & 6));
    return *x < renderer->params.width && *y < renderer->params.height;
}

/* Number of blocks that hold `pixels` pixels of a list. The last block may be filled in part. */
static uint32_t blocks_of(uint64_t pixels)
{
    return (uint32_t)((pixels + RENDER_BLOCK_PIXELS - 1) / RENDER_BLOCK_PIXELS);
}

whit_result render_finish_submission(struct target *target)
{
    struct renderer *renderer = target->renderer;
    commands_barrier(renderer->commands);
    whit_result result = commands_run(renderer->commands);
    if (result != WHIT_OK)
        return result;
    uint32_t span = 0;
    do {
        double device_ms = commands_span_ms(renderer->commands, span);
        if (device_ms < 0.0 || target->stats.render_device_ms < 0.0)
            target->stats.render_device_ms = -1.0;
        else
            target->stats.render_device_ms += device_ms;
    } while (++span < commands_span_count(renderer->commands));
    return status_check(target, false);
}

/* Pixels on a side of the largest tile for which the buffers have room. */
static uint32_t largest_tile(const struct renderer *renderer)
{
    return (uint32_t)ceil(sqrt((double)renderer->picture.buffers.chunk_slots));
}

uint32_t tiles_adapt(uint32_t tile, uint32_t largest, double spent_ms)
{
    uint32_t grown = 2 * tile < largest ? 2 * tile : largest;
    double growth = (double)grown / tile;
    if (spent_ms > SUBMISSION_LIMIT_MS && tile > TILE_MIN)
        return tile / 2 > TILE_MIN ? tile / 2 : TILE_MIN;
    return growth > 1.0 && growth * growth * spent_ms < SUBMISSION_LIMIT_MS ? grown : tile;
}

/* The next picture begins with the size that this one has come to. Its tiles may take longer, if it
   shows something else: so only where there is time for that. */
static void adapt_tile(struct renderer *renderer, struct progress *progress, double spent_ms)
{
    if (renderer->params.tile_size)
        return;
    renderer->tile = spent_ms < 0.5 * SUBMISSION_LIMIT_MS ? progress->tile : 0;
    progress->tile = tiles_adapt(progress->tile, largest_tile(renderer), spent_ms);
}

void render_take_sample(const struct target *target, uint32_t index, uint32_t samples,
                        struct gpu_chunk *chunk)
{
    const struct renderer *renderer = target->renderer;
    const struct pixel_buffers *p = &target->buffers;
    camera_sample(&renderer->frame, renderer->params.sampling.first + index, chunk);
    chunk->sample_weight = 1.0f / (float)samples;
    chunk->summed = index;
    chunk->samples = samples;
    chunk->sums_row = renderer->params.width * p->band_rows;
    chunk->sums_step = p->chunk_slots;
    chunk->before_post = p->before_post;
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
        render_take_sample(&renderer->picture, s, samples, chunk);
        result = views_take_sample(renderer, chunk);
        if (result == WHIT_OK)
            result = stages_sample(&renderer->picture, chunk, progress, &longest_ms);
        if (result != WHIT_OK)
            return result;
        progress->work_done += chunk->block_count;
        report_progress(renderer, progress);
    }
    ++renderer->picture.stats.tiles;
    adapt_tile(renderer, progress, longest_ms);
    return WHIT_OK;
}

/* Draws the band whose first row is `band_y`: all its blocks, or blocks of the list of those of its
   pixels that the pass draws. */
static whit_result render_band(struct renderer *renderer, uint32_t band_y,
                               struct progress *progress)
{
    const struct lattice *lattice = &progress->lattice;
    uint32_t left = lattice->height - band_y;
    uint32_t rows =
        left < renderer->picture.buffers.band_rows ? left : renderer->picture.buffers.band_rows;
    uint32_t across = pixels_blocks_across(lattice->width);
    renderer->picture.buffers.band_y = band_y;
    uint32_t block = band_y / 8 * across, end = block + pixels_blocks_across(rows) * across;
    uint32_t listed = 0;
    if (progress->listed) {
        whit_result result = adaptive_list(&renderer->picture, progress, block, end, &listed);
        if (result != WHIT_OK || listed == 0)
            return result == WHIT_OK ? render_stop_asked(renderer, progress) : result;
        block = 0;
        end = blocks_of(listed);
    }
    while (block < end) {
        uint32_t blocks = progress->tile * progress->tile / RENDER_BLOCK_PIXELS;
        uint32_t held = renderer->picture.buffers.chunk_slots / RENDER_BLOCK_PIXELS;
        blocks = blocks < held ? blocks : held;
        uint32_t max = renderer->picture.stages.blocks_max;
        blocks = max && max < blocks ? max : blocks;
        struct gpu_chunk chunk = {.first_block = block,
                                  .block_count = end - block < blocks ? end - block : blocks,
                                  .blocks_x = across,
                                  .lattice = lattice_word(lattice),
                                  .band_y = band_y,
                                  .band_rows = lattice->spacing_y * rows,
                                  .listed = listed};
        whit_result result = render_chunk(renderer, &chunk, progress);
        if (result != WHIT_OK)
            return result;
        block += chunk.block_count;
        renderer->picture.stats.tile_size = progress->tile;
    }
    return readback_band(renderer, progress, band_y, rows);
}

static uint64_t blocks_of_pass(const struct renderer *renderer, const struct progress *progress)
{
    const struct lattice *lattice = &progress->lattice;
    uint32_t rows = lattice->height - renderer->params.first_row;
    if (progress->listed)
        return blocks_of(progress->listed) + rows / renderer->picture.buffers.band_rows;
    return (uint64_t)pixels_blocks_across(lattice->width) * pixels_blocks_across(rows);
}

whit_result render_pass(struct renderer *renderer, uint32_t samples, struct progress *progress)
{
    const struct lattice *lattice = &progress->lattice;
    whit_result result = WHIT_OK;
    progress->samples = samples;
    progress->work_done = 0;
    uint32_t first = renderer->params.first_row;
    progress->work_total = blocks_of_pass(renderer, progress) * samples;
    for (uint32_t y = first; result == WHIT_OK && y < lattice->height;
         y += renderer->picture.buffers.band_rows)
        result = render_band(renderer, y, progress);
    if (result == WHIT_OK) {
        progress->before += progress->share;
        progress->work_done = 0;
    }
    return result;
}

/* The base-4 logarithm of `samples`, rounded up. */
static uint32_t log4_up(uint32_t samples)
{
    uint32_t level = 0;
    while (1u << (2 * level) < samples)
        ++level;
    return level;
}

/* Plans the next pass, with progress by samples: `done` before it, `now` in it, about `later` in
   those behind it. */
static void plan_pass(struct progress *progress, double done, double now, double later)
{
    progress->before = fmax(progress->before, done / (done + now + later));
    progress->share = now > 0.0 ? (1.0 - progress->before) * now / (now + later) : 0.0;
}

/* sampling.count samples for all pixels; then 4 times as many for pixels that differ from a
   neighbour, and so on up to sampling.count_max. The comparison needs the whole picture, so each
   pass goes over all bands. */
static whit_result render_adaptive(struct renderer *renderer, struct progress *progress)
{
    const whit_renderer_params *params = &renderer->params;
    size_t pixels = (size_t)params->width * params->height;
    progress->levels = array_alloc(pixels, sizeof *progress->levels);
    if (!progress->levels)
        return render_no_memory(renderer, "the samples of pixels");
    uint8_t first = (uint8_t)log4_up(params->sampling.count),
            last = (uint8_t)log4_up(params->sampling.count_max);
    memset(progress->levels, first, pixels);
    double done = (double)pixels * params->sampling.count;
    plan_pass(progress, 0.0, done, done);
    whit_result result = render_pass(renderer, params->sampling.count, progress);
    for (uint8_t level = first + 1; result == WHIT_OK && level <= last; ++level) {
        uint64_t marked = adaptive_mark(&renderer->planes[PLANE_COLOR], params->sampling.contrast,
                                        level, progress->levels);
        renderer->picture.stats.rays_primary += marked << (2 * level);
        progress->listed = marked;
        double now = (double)(marked << (2 * level)), all = now;
        for (uint8_t next = level; next < last; ++next)
            all = now + 4.0 * all; /* as if those behind drew the same pixels */
        plan_pass(progress, done, now, all - now);
        done += now;
        if (marked > 0)
            result = render_pass(renderer, 1u << (2 * level), progress);
    }
    if (result == WHIT_OK)
        report_progress(renderer, progress);
    for (size_t i = 0; i < pixels; ++i)
        ++renderer->picture.stats.pixels_by_samples[progress->levels[i]];
    free(progress->levels);
    progress->levels = NULL;
    return result;
}

static whit_result render_picture(struct renderer *renderer, struct progress *progress)
{
    const whit_renderer_params *params = &renderer->params;
    uint64_t pixels = (uint64_t)params->width * views_image_rows(renderer);
    renderer->picture.stats.rays_primary = pixels * params->sampling.count;
    if (params->sampling.kind == WHIT_SAMPLING_ADAPTIVE)
        return render_adaptive(renderer, progress);
    renderer->picture.stats.pixels_by_samples[log4_up(params->sampling.count)] = pixels;
    if (steps_are_wanted(renderer))
        return steps_render(renderer, progress);
    return render_pass(renderer, params->sampling.count, progress);
}

whit_result renderer_render(struct renderer *renderer)
{
    whit_result result = views_leave(renderer);
    return result == WHIT_OK ? render_all(renderer) : result;
}

struct progress render_progress(const struct renderer *renderer)
{
    uint32_t asked = renderer->params.tile_size;
    uint32_t largest = largest_tile(renderer);
    bool cpu = device_get_info(renderer->device)->kind == WHIT_DEVICE_CPU;
    uint32_t usual = cpu ? TILE_FIRST_CPU : TILE_FIRST;
    uint32_t first = renderer->tile > usual ? renderer->tile : usual;
    return (struct progress){
        .lattice = lattice_whole(renderer),
        .start_ms = clock_ms(),
        .tile = asked                                    ? asked
                : renderer->accel->no_trees              ? TILE_MIN
                : largest < first && largest >= TILE_MIN ? largest
                                                         : first,
        .share = 1.0,
    };
}

whit_result render_all(struct renderer *renderer)
{
    renderer->rendered = false;
    if (renderer->between_times || renderer->between_views)
        return log_usage(&renderer->log,
                         "its time or view could not be set, so there is nothing to render");
    readback_drop_images(renderer);
    costs_clear(renderer);
    whit_result result = params_check_loops(renderer);
    if (result == WHIT_OK && !renderer->picture.buffers.pixels) /* dropped after an error */
        result = retarget_pixels(renderer);
    if (result == WHIT_OK)
        result = renderer_compile(renderer);
    if (result == WHIT_OK && reuse_is_possible(renderer))
        return reuse_render(renderer);
    bool outlives = result == WHIT_OK && reuse_outlives(renderer);
    renderer->kept.known = false;
    if (result == WHIT_OK && !readback_is_late(renderer))
        result = readback_make_images(renderer);
    stats_clear(&renderer->picture);
    material_shares_clear(&renderer->picture);
    struct progress progress = render_progress(renderer);
    if (result == WHIT_OK)
        result = deferred_clear(&renderer->picture);
    if (result == WHIT_OK)
        result = render_picture(renderer, &progress);
    if (result == WHIT_OK)
        result = deferred_read(&renderer->picture, &renderer->picture.stats.deferred);
    renderer->picture.stats.render_ms = clock_ms() - progress.start_ms;
    renderer->rendered = result == WHIT_OK;
    if (renderer->rendered)
        reuse_note(renderer);
    else if (result == WHIT_ERROR_CANCELLED)
        renderer->kept.known = outlives;
    return result;
}

whit_result params_check_loops(const struct renderer *renderer)
{
    const struct accel *accel = renderer->accel;
    const struct scene *scene = renderer->scene;
    bool shadows = renderer->effects.called[SCENE_EFFECT_SHADOWS];
    uint64_t rays = shadows ? lights_samples(renderer) : 1;
    if (!accel->no_trees || !device_get_limits(renderer->device)->loop_limited ||
        rays * accel->iterations <= ACCEL_ITERATIONS_MAX)
        return WHIT_OK;
    return log_usage(
        &renderer->log,
        "%s: without trees every ray tests %llu primitives, which is too much where each hit "
        "takes %llu rays at once: fewer --light-samples are possible",
        scene->name, (unsigned long long)(scene->triangle_total + scene->sphere_total),
        (unsigned long long)rays);
}

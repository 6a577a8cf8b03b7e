/* Batches of rays are uploaded, traced and read back in pieces that fit the device's buffers and
   finish soon. */
#include "render/renderer.h"
#include "render/tiles.h"
#include "render/upload.h"
#include "render/variants.h"

#include <stdlib.h>

#include "accel/pose.h"
#include "base/array.h"
#include "base/clock.h"
#include "device/buffer.h"
#include "device/commands.h"

enum {
    TRACE_CAPACITY = 1 << 20,  /* most rays of a piece */
    TRACE_FIRST_CPU = 1 << 14, /* rays of the first piece on a CPU device */
    TRACE_FIRST = 1 << 20, /* rays of the first piece on other devices, which have more threads */
    TRACE_FIRST_BARE = 1 << 10, /* rays of the first piece without trees */
    TRACE_BEAMS_MIN = 1 << 17,  /* batches of fewer rays gain nothing by packets */
};
/* Time of a piece: long enough to keep the device busy, short enough for watchdogs and Ctrl+C. */
static const double TRACE_TARGET_MS = 150.0;

void trace_finish(struct trace_state *trace)
{
    buffer_destroy(trace->rays);
    buffer_destroy(trace->hits);
    buffer_destroy(trace->costs);
    buffer_destroy(trace->deferred);
    *trace = (struct trace_state){0};
}

/* Later pieces may be four times as large each, up to the capacity. */
static uint32_t first_piece(const struct renderer *renderer)
{
    bool cpu = device_get_info(renderer->device)->kind == WHIT_DEVICE_CPU;
    uint32_t first = renderer->accel->no_trees ? TRACE_FIRST_BARE
                     : cpu                     ? TRACE_FIRST_CPU
                                               : TRACE_FIRST;
    return first < renderer->trace.capacity ? first : renderer->trace.capacity;
}

static uint32_t choose_capacity(uint32_t max_rays)
{
    uint32_t capacity = TRACE_FIRST_CPU;
    while (capacity < TRACE_CAPACITY && (max_rays == 0 || capacity < max_rays))
        capacity *= 4;
    return capacity;
}

static whit_result prepare_pass(struct renderer *renderer, bool any, bool beams)
{
    struct pass *pass = &renderer->trace.passes[beams][any];
    return pass->pipeline ? WHIT_OK : variant_create_trace(renderer, any, beams, pass);
}

static whit_result prepare(struct renderer *renderer, bool any, bool beams)
{
    struct trace_state *trace = &renderer->trace;
    whit_result result = beams ? upload_wide(renderer) : WHIT_OK;
    if (result != WHIT_OK)
        return result;
    beams = beams && renderer->packet_stack_size <= PACKET_STACK_MAX;
    if (!trace->rays)
        trace->capacity = choose_capacity(renderer->params.trace_rays);
    uint32_t loads = renderer->scene_buffers.texel_loads ? BUFFER_TEXELS : BUFFER_STORAGE;
    bool lists = variant_has_deferred(&renderer->picture) || variant_has_beams(renderer);
    uint64_t rays = trace->capacity, bytes = 0;
    const struct buffer_request all[] = {
        {&trace->rays, rays * sizeof(struct gpu_ray), loads | BUFFER_HOST, "rays"},
        {&trace->hits, rays * sizeof(struct gpu_hit), BUFFER_STORAGE | BUFFER_HOST, "hits"},
        {&trace->costs, renderer->params.count ? rays * sizeof(struct gpu_cost) : 0,
         BUFFER_STORAGE | BUFFER_HOST, "trace costs"},
        {&trace->deferred, lists ? sizeof(struct gpu_work) + rays * 4 : 0,
         BUFFER_STORAGE | BUFFER_INDIRECT, "deferred rays"},
    };
    result = buffer_create_all(renderer->device, all, sizeof all / sizeof *all, &bytes);
    if (result == WHIT_OK)
        result = prepare_pass(renderer, any, false);
    if (result == WHIT_OK && beams)
        result = prepare_pass(renderer, any, true);
    return result;
}

/* Traces rays [0, batch->ray_count) of the ray buffer. `beams`: in packets where possible, then the
   rest ray by ray. */
static whit_result dispatch(struct renderer *renderer, bool any, bool beams,
                            const struct gpu_batch *batch)
{
    const struct pass *singles = &renderer->trace.passes[false][any];
    const struct pass *pass = &renderer->trace.passes[beams][any];
    uint32_t each = RENDER_GROUP_SIZE * pass->rays_each;
    whit_result result = commands_begin(renderer->commands);
    if (result != WHIT_OK)
        return result;
    commands_fill(renderer->commands, renderer->picture.buffers.status, 0, 4, 0);
    render_clear_deferred(renderer, renderer->trace.deferred);
    commands_barrier(renderer->commands);
    commands_bind(renderer->commands, pass->pipeline, pass->set);
    commands_push(renderer->commands, batch, sizeof *batch);
    commands_span_begin(renderer->commands, "trace");
    commands_dispatch(renderer->commands, (batch->ray_count + each - 1) / each, 1, 1);
    struct gpu_batch again = *batch;
    again.deferred = 1;
    if (beams || pass->deferred)
        render_take_deferred(renderer->commands, beams ? singles->pipeline : pass->deferred,
                             beams ? singles->set : pass->deferred_set, renderer->trace.deferred,
                             &again, sizeof again);
    commands_span_end(renderer->commands);
    commands_barrier(renderer->commands);
    result = commands_run(renderer->commands);
    if (result == WHIT_OK)
        renderer->trace.device_ms += commands_span_ms(renderer->commands, 0);
    return result == WHIT_OK ? status_check(&renderer->picture, true) : result;
}

static whit_result cancelled(const struct renderer *renderer)
{
    return renderer->params.cancel && *renderer->params.cancel ? WHIT_ERROR_CANCELLED : WHIT_OK;
}

/* Traces rays [0, count) of the ray buffer. *beams: whether to try packets; afterwards, whether
   most rays were traced in packets. */
static whit_result trace_piece(struct renderer *renderer, bool any, bool *beams, uint32_t count)
{
    const struct accel *accel = renderer->accel;
    struct gpu_batch batch = {.ray_count = count, .root = renderer->frame.root};
    if (accel->instance_count == 0)
        batch.root = BVH_EMPTY_REF;
    *beams = *beams && accel->instance_count > 0 && renderer->trace.passes[true][any].pipeline;
    if (!*beams)
        return dispatch(renderer, any, false, &batch);
    batch.root8 = accel->bvh8.mesh_roots[accel->flat ? 0 : renderer->scene->instances[0].mesh];
    whit_result result = dispatch(renderer, any, true, &batch);
    struct gpu_work alone;
    if (result == WHIT_OK)
        result = buffer_read(renderer->trace.deferred, 0, &alone, sizeof alone);
    if (result != WHIT_OK)
        return result;
    *beams = alone.count < count / 2;
    renderer->trace.together += alone.count < count ? count - alone.count : 0;
    return WHIT_OK;
}

static whit_result read_hits(const struct renderer *renderer, bool any, uint64_t count,
                             struct gpu_hit *hits)
{
    if (!any)
        return buffer_read(renderer->trace.hits, 0, hits, count * sizeof *hits);
    uint32_t *blocked = array_alloc(count, sizeof *blocked);
    if (!blocked)
        return render_no_memory(renderer, "hits");
    whit_result result = buffer_read(renderer->trace.hits, 0, blocked, count * sizeof *blocked);
    for (uint64_t i = 0; result == WHIT_OK && i < count; ++i)
        hits[i] = (struct gpu_hit){.primitive = blocked[i] ? 0 : HIT_NONE,
                                   .instance = blocked[i] ? 0 : HIT_NONE};
    free(blocked);
    return result;
}

whit_result renderer_trace(struct renderer *renderer, const struct gpu_ray *rays, uint64_t count,
                           bool any, struct gpu_hit *hits, struct gpu_cost *costs)
{
    if (costs && !renderer->params.count)
        return log_usage(&renderer->log, "costs of rays: not asked for when the renderer was made");
    if (renderer->between_times) { /* trees and root may be of different times */
        return log_usage(&renderer->log, "its time could not be set, so there is nothing to trace");
    }
    renderer->trace.device_ms = 0.0;
    renderer->trace.together = 0;
    bool many = count >= TRACE_BEAMS_MIN || renderer->params.packets == WHIT_PACKETS_ON;
    bool beams = many && variant_has_beams(renderer);
    whit_result result = accel_pose_again(renderer->accel, &renderer->pose);
    if (result == WHIT_OK)
        result = prepare(renderer, any, beams);
    if (result == WHIT_OK)
        result = deferred_clear(&renderer->picture);
    uint64_t piece = first_piece(renderer);
    for (uint64_t done = 0; result == WHIT_OK && done < count;) {
        result = cancelled(renderer);
        if (result != WHIT_OK)
            break;
        uint64_t size = count - done < piece ? count - done : piece;
        double start_ms = clock_ms();
        result = buffer_write(renderer->trace.rays, 0, rays + done, size * sizeof *rays);
        if (result == WHIT_OK)
            result = trace_piece(renderer, any, &beams, (uint32_t)size);
        if (result == WHIT_OK)
            result = read_hits(renderer, any, size, hits + done);
        if (result == WHIT_OK && costs)
            result = buffer_read(renderer->trace.costs, 0, costs + done, size * sizeof *costs);
        if (clock_ms() - start_ms < TRACE_TARGET_MS / 4 && piece < renderer->trace.capacity)
            piece *= 4;
        done += size;
    }
    if (result == WHIT_OK)
        result = deferred_read(&renderer->picture, &renderer->trace.deferred_count);
    return result;
}

double renderer_trace_device_ms(const struct renderer *renderer)
{
    return renderer->trace.device_ms;
}

uint64_t renderer_trace_together(const struct renderer *renderer)
{
    return renderer->trace.together;
}

/* One pixel once more, by a kernel that records its rays (bind/probe.glsl). It works on pixel
   buffers of its own, which take the place of the renderer's meanwhile, so that the picture stays.
 */
#include "render/probe.h"

#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "render/renderer.h"

enum { PROBE_ADAPTIVE_SAMPLES = 4 };

/* ---- On the device ---- */

static void exchange_passes(struct pass *a, struct pass *b)
{
    struct pass kept = *a;
    *a = *b;
    *b = kept;
}

/* The renderer's pixel buffers and passes for those of the probe, or back. */
static void exchange(struct renderer *renderer)
{
    struct probe_state *probe = &renderer->probe;
    struct pixel_buffers kept = renderer->pixel_buffers;
    renderer->pixel_buffers = probe->pixel_buffers;
    probe->pixel_buffers = kept;
    exchange_passes(&renderer->whitted, &probe->whitted);
    probe->active = !probe->active;
}

static whit_result create_buffers(struct renderer *renderer)
{
    struct probe_state *probe = &renderer->probe;
    uint64_t bytes =
        sizeof(struct gpu_probe) + (uint64_t)PROBE_RAYS_MOST * sizeof(struct gpu_probe_ray);
    whit_result result = WHIT_OK;
    if (!probe->records)
        result = buffer_create(renderer->device, bytes, BUFFER_STORAGE | BUFFER_HOST, "probed rays",
                               &probe->records);
    if (result == WHIT_OK && !renderer->pixel_buffers.pixels)
        result = pixels_create(renderer, 8, TILE_MIN);
    if (result != WHIT_OK)
        pixels_finish(&renderer->pixel_buffers);
    return result;
}

static whit_result create_passes(struct renderer *renderer)
{
    if (renderer->whitted.pipeline && renderer->whitted.sets[0])
        return WHIT_OK;
    whit_result result = renderer->whitted.pipeline
                             ? variant_bind_whitted(renderer, &renderer->whitted)
                             : variant_create_whitted(renderer);
    if (result != WHIT_OK)
        pass_finish(&renderer->whitted);
    return result;
}

/* The block of 8 x 8 that the pixel is in; the kernel leaves all others of it alone. */
static whit_result trace_pixel(struct renderer *renderer, struct probe_report *report)
{
    const struct render_params *params = &renderer->params;
    uint32_t block_y = report->y / 8, rows = params->height - block_y * 8;
    struct gpu_chunk chunk = {.first_block =
                                  block_y * pixels_blocks_across(params->width) + report->x / 8,
                              .block_count = 1,
                              .band_y = block_y * 8,
                              .band_rows = rows < 8 ? rows : 8};
    const struct progress progress = {.share = 1.0, .work_total = 1};
    double longest_ms = 0.0;
    whit_result result = WHIT_OK;
    renderer->pixel_buffers.band_y = chunk.band_y;
    for (uint32_t s = 0; result == WHIT_OK && s < report->samples; ++s) {
        result = render_stop_asked(renderer, &progress);
        render_take_sample(renderer, s, report->samples, &chunk);
        if (result == WHIT_OK)
            result = render_sample(renderer, &chunk, &progress, &longest_ms);
    }
    uint64_t pixel = (uint64_t)(report->y % 8) * params->width + report->x;
    if (result == WHIT_OK)
        result = buffer_read(renderer->pixel_buffers.pixels, pixel * sizeof report->color,
                             report->color, sizeof report->color);
    return result;
}

/* *records is free()d by the caller. */
static whit_result read_records(const struct renderer *renderer, struct probe_report *report,
                                struct gpu_probe_ray **records)
{
    struct gpu_probe head;
    whit_result result = buffer_read(renderer->probe.records, 0, &head, sizeof head);
    if (result != WHIT_OK)
        return result;
    report->ray_count = head.count < head.capacity ? head.count : head.capacity;
    report->dropped = head.count - report->ray_count;
    *records = array_alloc(report->ray_count, sizeof **records);
    if (!*records)
        return render_no_memory(renderer, "probed rays");
    return buffer_read(renderer->probe.records, sizeof head, *records,
                       (uint64_t)report->ray_count * sizeof **records);
}

static whit_result run(struct renderer *renderer, uint32_t most, struct probe_report *report,
                       struct gpu_probe_ray **records)
{
    const struct render_stats stats = renderer->stats;
    const struct gpu_probe head = {.pixel_x = report->x, .pixel_y = report->y, .capacity = most};
    exchange(renderer);
    whit_result result = create_buffers(renderer);
    if (result == WHIT_OK)
        result = create_passes(renderer);
    if (result == WHIT_OK)
        result = buffer_write(renderer->probe.records, 0, &head, sizeof head);
    if (result == WHIT_OK)
        result = trace_pixel(renderer, report);
    if (result == WHIT_OK)
        result = read_records(renderer, report, records);
    exchange(renderer);
    renderer->stats = stats;
    return result;
}

void probe_finish(struct probe_state *probe)
{
    pass_finish(&probe->whitted);
    pixels_finish(&probe->pixel_buffers);
    buffer_destroy(probe->records);
    *probe = (struct probe_state){0};
}

void probe_drop_pixels(struct renderer *renderer)
{
    struct probe_state *probe = &renderer->probe;
    pass_unbind(&probe->whitted);
    renderer->scene_buffers.bytes -= probe->pixel_buffers.bytes;
    pixels_finish(&probe->pixel_buffers);
}

/* ---- The tree ---- */

static bool is_shadow(const struct gpu_probe_ray *record)
{
    return (record->kind & PROBE_KIND_MASK) == RAY_SHADOW;
}

/* Of each record, while the tree is put in order. */
struct branch {
    uint32_t first, count; /* of those that it left, which are next to each other */
    uint32_t place;        /* in the tree */
    uint32_t waiting;      /* a stack of records: what the ray stack was on the device */
};

/* Its shadow rays first, then what was on top of the ray stack: the last of the others. */
static uint32_t push_branches(const struct gpu_probe_ray *records, uint32_t first, uint32_t count,
                              struct branch *branches, uint32_t top)
{
    for (uint32_t i = first; i < first + count; ++i) {
        if (!is_shadow(&records[i]))
            branches[top++].waiting = i;
    }
    for (uint32_t i = first + count; i-- > first;) {
        if (is_shadow(&records[i]))
            branches[top++].waiting = i;
    }
    return top;
}

static void place_ray(const struct gpu_probe_ray *record, const struct branch *branches,
                      struct probe_ray *rays, uint32_t place)
{
    struct probe_ray *ray = &rays[place];
    *ray = (struct probe_ray){.traced = *record, .parent = HIT_NONE};
    if (record->parent == PROBE_RAYS_MOST)
        return;
    ray->parent = branches[record->parent].place;
    ray->generation = rays[ray->parent].generation + 1;
    if (record->end == PROBE_DEPTH || record->end == PROBE_BAILOUT) {
        for (int i = 0; i < 3; ++i)
            ray->traced.origin[i] = rays[ray->parent].traced.point[i];
    }
}

/* False where the records are no tree with every ray at its end, which no kernel should leave. */
static bool count_branches(const struct gpu_probe_ray *records, uint32_t count,
                           struct branch *branches)
{
    for (uint32_t i = 0; i < count; ++i) {
        uint32_t parent = records[i].parent;
        if (records[i].end == PROBE_WAITS || (i == 0) != (parent == PROBE_RAYS_MOST) ||
            (i > 0 && parent >= i))
            return false;
        if (i == 0)
            continue;
        if (branches[parent].count++ == 0)
            branches[parent].first = i;
        if (branches[parent].first + branches[parent].count != i + 1)
            return false;
    }
    return true;
}

static whit_result order_rays(const struct renderer *renderer, const struct gpu_probe_ray *records,
                              struct probe_report *report)
{
    uint32_t count = report->ray_count, top = 0, place = 0;
    struct branch *branches = calloc(count ? count : 1, sizeof *branches);
    report->rays = array_alloc(count, sizeof *report->rays);
    whit_result result = WHIT_OK;
    if (!branches || !report->rays) {
        result = render_no_memory(renderer, "probed rays");
    } else if (!count_branches(records, count, branches)) {
        log_error(&renderer->log, "the rays of pixel %u,%u do not make a tree", report->x,
                  report->y);
        result = WHIT_ERROR_STATUS;
    } else if (count > 0) {
        branches[top++].waiting = 0;
    }
    while (top > 0) {
        uint32_t record = branches[--top].waiting;
        branches[record].place = place;
        place_ray(&records[record], branches, report->rays, place++);
        top = push_branches(records, branches[record].first, branches[record].count, branches, top);
    }
    free(branches);
    return result;
}

static whit_result check(const struct renderer *renderer, uint32_t x, uint32_t y)
{
    const struct render_params *params = &renderer->params;
    if (x < params->width && y < params->height) {
        if (!renderer->between_times)
            return WHIT_OK;
        log_error(&renderer->log, "its time could not be set, so there is nothing to probe");
        return WHIT_ERROR_USAGE;
    }
    log_error(&renderer->log,
              "pixel %u,%u is outside of the picture, whose pixels are 0,0 to %u,%u", x, y,
              params->width - 1, params->height - 1);
    return WHIT_ERROR_USAGE;
}

whit_result renderer_probe(struct renderer *renderer, uint32_t x, uint32_t y, uint32_t most,
                           struct probe_report *out)
{
    const struct render_params *params = &renderer->params;
    struct gpu_probe_ray *records = NULL;
    *out = (struct probe_report){.x = x,
                                 .y = y,
                                 .light_samples = renderer->frame.light_samples,
                                 .samples = params->adaptive > 0.0 ? PROBE_ADAPTIVE_SAMPLES
                                                                   : params->samples};
    whit_result result = check(renderer, x, y);
    if (result == WHIT_OK)
        result = params_check_loops(renderer);
    if (result == WHIT_OK)
        result = run(renderer, most > 0 && most < PROBE_RAYS_MOST ? most : PROBE_RAYS_MOST, out,
                     &records);
    if (result == WHIT_OK)
        result = order_rays(renderer, records, out);
    if (result == WHIT_OK)
        result = probe_ask_twin(renderer, out);
    free(records);
    if (result != WHIT_OK)
        probe_report_finish(out);
    return result;
}

void probe_report_finish(struct probe_report *report)
{
    free(report->rays);
    *report = (struct probe_report){0};
}

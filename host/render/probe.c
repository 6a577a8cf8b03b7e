/* Draws one pixel once more, with kernels that record its rays (bind/probe.glsl), into a target of
   its own, so that the picture stays. */
#include "render/probe.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "device/buffer.h"
#include "render/hooks.h"
#include "render/pixels.h"
#include "render/readback.h"
#include "render/renderer.h"
#include "render/stage_set.h"
#include "render/stages.h"
#include "render/tiles.h"
#include "render/views.h"

#define DBG_HEAD  ((uint64_t)DBG_CALLS * sizeof(uint32_t))
#define DBG_BYTES (DBG_HEAD + (uint64_t)DBG_CALLS * DBG_VALUES * sizeof(struct gpu_dbg))

/* The records of a probe before they are sorted into a tree. */
struct record_list {
    struct gpu_probe_ray *records; /* free() both */
    /* PROBE_RAYS_MAX entries: index in `records` by id of a ray; HIT_NONE: there is no such ray. */
    uint32_t *places;
};

/* ---- On the device ---- */

static whit_result create_buffers(struct target *probe)
{
    const struct buffer_request all[] = {
        {&probe->records,
         sizeof(struct gpu_probe) + 2 * (uint64_t)PROBE_RAYS_MAX * sizeof(struct gpu_probe_ray),
         BUFFER_STORAGE | BUFFER_HOST, "probed rays"},
        {&probe->dbg, hooks_dbg_count(probe) ? DBG_BYTES : 0, BUFFER_STORAGE | BUFFER_HOST,
         "values of dbg(x)"},
    };
    uint64_t bytes = 0;
    whit_result result = buffer_create_all(probe->renderer->device, all, 2, &bytes);
    if (result == WHIT_OK && !probe->buffers.pixels)
        result = pixels_create(probe, 8, TILE_MIN);
    if (result != WHIT_OK)
        target_drop_pixels(probe);
    return result;
}

static whit_result trace_pixel(struct target *target, struct probe_report *report)
{
    struct renderer *renderer = target->renderer;
    const whit_renderer_params *params = &renderer->params;
    uint32_t block_y = report->y / 8, rows = params->height - block_y * 8;
    struct gpu_chunk chunk = {.block_count = 1,
                              .blocks_x = pixels_blocks_across(params->width),
                              .band_y = block_y * 8,
                              .band_rows = rows < 8 ? rows : 8,
                              .listed = 1};
    const struct progress progress = {.share = 1.0, .work_total = 1};
    double longest_ms = 0.0;
    const uint32_t pixel_word = report->x | report->y << LISTED_Y_SHIFT;
    whit_result result = buffer_write(target->buffers.listed, 0, &pixel_word, sizeof pixel_word);
    target->buffers.band_y = chunk.band_y;
    for (uint32_t s = 0; result == WHIT_OK && s < report->samples; ++s) {
        result = render_stop_asked(renderer, &progress);
        render_take_sample(target, s, report->samples, &chunk);
        if (result == WHIT_OK)
            result = stages_sample(target, &chunk, &progress, &longest_ms);
    }
    uint64_t pixel = (uint64_t)(report->y % 8) * params->width + report->x;
    if (result == WHIT_OK)
        result = buffer_read(target->buffers.pixels, pixel * sizeof report->color, report->color,
                             sizeof report->color);
    return result;
}

static bool is_shadow(const struct gpu_probe_ray *record)
{
    return (record->kind & PROBE_KIND_MASK) == RAY_SHADOW;
}

/* Sorts by parent, then by kind: shadow rays, refracted, straight on, reflected. So the children of
   a ray are next to each other, and no ray comes before its parent. */
static int compare_records(const void *a, const void *b)
{
    uint64_t keys[2];
    for (int i = 0; i < 2; ++i) {
        const struct gpu_probe_ray *r = i ? b : a;
        bool reflected = (r->kind & PROBE_KIND_MASK) == RAY_REFLECTED;
        uint64_t which = is_shadow(r) ? 0 : r->kind & PROBE_STRAIGHT ? 2 : reflected ? 3 : 1;
        uint64_t parent = r->parent == PROBE_RAYS_MAX ? 0 : (uint64_t)r->parent + 1;
        keys[i] = parent << 40 | which << 36 | (which ? 0 : r->light_sample);
    }
    return (keys[0] > keys[1]) - (keys[0] < keys[1]);
}

/* Replaces each parent's id by its index in the sorted records. A traced ray has its id in
   light_sample. */
static void name_places(struct gpu_probe_ray *records, uint32_t count, uint32_t *places)
{
    for (uint32_t i = 0; i < count; ++i) {
        struct gpu_probe_ray *r = &records[i];
        if (r->parent != PROBE_RAYS_MAX)
            r->parent = places[r->parent];
        if (is_shadow(r))
            continue;
        if (r->light_sample != HIT_NONE)
            places[r->light_sample] = i;
        r->light_sample = 0;
    }
}

/* Multiplies the weights of rays behind shadow catchers by the share that the catchers let through.
   `shares`: for each record, the product of these shares on its way. */
static void weigh_caught(struct gpu_probe_ray *records, uint32_t count, float (*shares)[3])
{
    static const float whole[3] = {1, 1, 1};
    for (uint32_t i = 0; i < count; ++i) {
        struct gpu_probe_ray *r = &records[i];
        bool first = r->parent == PROBE_RAYS_MAX;
        const struct gpu_probe_ray *parent = first ? NULL : &records[r->parent];
        for (int k = 0; k < 3; ++k) {
            float share = first ? whole[k] : shares[r->parent][k];
            shares[i][k] = share;
            if (!first && !is_shadow(r) && parent->kind & PROBE_CATCHER)
                shares[i][k] *= parent->added[k];
            r->weight[k] *= shares[i][k];
            if (!is_shadow(r) && !(r->kind & PROBE_CATCHER))
                r->added[k] *= shares[i][k];
        }
    }
    for (uint32_t i = 0; i < count; ++i) {
        if (records[i].kind & PROBE_CATCHER)
            memset(records[i].added, 0, sizeof records[i].added);
        records[i].kind &= ~PROBE_CATCHER;
    }
}

/* Sorts the records from the order of ids to that of a tree. */
static whit_result sort_records(const struct renderer *renderer, struct record_list *list,
                                uint32_t count)
{
    list->places = array_alloc(PROBE_RAYS_MAX, sizeof *list->places);
    float(*shares)[3] = array_alloc(count, sizeof *shares);
    whit_result result = WHIT_OK;
    if (list->places && shares) {
        memset(list->places, 0xff, PROBE_RAYS_MAX * sizeof *list->places);
        qsort(list->records, count, sizeof *list->records, compare_records);
        name_places(list->records, count, list->places);
        weigh_caught(list->records, count, shares);
    } else {
        result = render_no_memory(renderer, "probed rays");
    }
    free(shares);
    return result;
}

static uint32_t min(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static whit_result read_records(const struct renderer *renderer, uint32_t max,
                                struct probe_report *report, struct record_list *list)
{
    struct gpu_probe head;
    struct buffer *buffer = renderer->probe.records;
    whit_result result = buffer_read(buffer, 0, &head, sizeof head);
    if (result != WHIT_OK)
        return result;
    uint32_t rays = min(head.rays, PROBE_RAYS_MAX);
    uint32_t others = min(head.others, PROBE_RAYS_MAX);
    list->records = array_alloc((size_t)rays + others, sizeof *list->records);
    if (!list->records)
        return render_no_memory(renderer, "probed rays");
    uint64_t bytes = sizeof *list->records;
    result = buffer_read(buffer, sizeof head, list->records, rays * bytes);
    if (result == WHIT_OK)
        result = buffer_read(buffer, sizeof head + PROBE_RAYS_MAX * bytes, list->records + rays,
                             others * bytes);
    if (result == WHIT_OK)
        result = sort_records(renderer, list, rays + others);
    report->ray_count = min(rays + others, max);
    report->dropped = head.rays + head.others - report->ray_count;
    return result;
}

/* Reads the values of dbg(x) in the order in which the device has left them. */
static whit_result read_values(const struct renderer *renderer, struct probe_report *report)
{
    struct buffer *buffer = renderer->probe.dbg;
    uint32_t calls = hooks_dbg_count(&renderer->probe);
    if (!calls)
        return WHIT_OK;
    struct gpu_dbg kept[DBG_VALUES];
    report->values = array_alloc((size_t)calls * DBG_VALUES, sizeof *report->values);
    if (!report->values)
        return render_no_memory(renderer, "values of dbg(x)");
    whit_result result = buffer_read(buffer, 0, report->call_counts, DBG_HEAD);
    for (uint32_t call = 0; result == WHIT_OK && call < calls; ++call) {
        uint32_t count = min(report->call_counts[call], DBG_VALUES);
        if (count)
            result = buffer_read(buffer, DBG_HEAD + (uint64_t)call * sizeof kept, kept,
                                 count * sizeof *kept);
        for (uint32_t i = 0; result == WHIT_OK && i < count; ++i)
            report->values[report->value_count++] = (struct probe_value){kept[i], call, HIT_NONE};
    }
    return result;
}

static whit_result clear_values(const struct target *probe)
{
    static const uint32_t none[DBG_CALLS] = {0};
    return hooks_dbg_count(probe) ? buffer_write(probe->dbg, 0, none, sizeof none) : WHIT_OK;
}

static whit_result run(struct renderer *renderer, uint32_t max, struct probe_report *report,
                       struct record_list *list)
{
    struct target *probe = &renderer->probe;
    const struct gpu_probe head = {0};
    whit_result result = create_buffers(probe);
    if (result == WHIT_OK)
        result = stages_compile(probe);
    if (result == WHIT_OK)
        result = buffer_write(probe->records, 0, &head, sizeof head);
    if (result == WHIT_OK)
        result = clear_values(probe);
    if (result == WHIT_OK)
        result = trace_pixel(probe, report);
    if (result == WHIT_OK)
        result = read_records(renderer, max, report, list);
    if (result == WHIT_OK)
        result = read_values(renderer, report);
    return result;
}

/* ---- The tree ---- */

/* The place of a record in the ray tree. */
struct branch {
    uint32_t first, count; /* records of its child rays, next to each other */
    uint32_t place;        /* index in the ordered tree */
};

static void place_ray(const struct gpu_probe_ray *record, const struct branch *branches,
                      struct probe_ray *rays, uint32_t place)
{
    struct probe_ray *ray = &rays[place];
    *ray = (struct probe_ray){.traced = *record, .parent = HIT_NONE};
    if (record->parent == PROBE_RAYS_MAX)
        return;
    ray->parent = branches[record->parent].place;
    ray->generation = rays[ray->parent].generation + 1;
    if (record->end == PROBE_DEPTH || record->end == PROBE_BAILOUT) {
        for (int i = 0; i < 3; ++i)
            ray->traced.origin[i] = rays[ray->parent].traced.point[i];
    }
}

/* Puts a record into the tree, then its shadow rays, in their order, then its other child rays with
   theirs, the last one first. No tree is deeper than there are generations. */
static void place_tree(const struct gpu_probe_ray *records, uint32_t record,
                       struct branch *branches, struct probe_ray *rays, uint32_t *placed)
{
    uint32_t first = branches[record].first, end = first + branches[record].count;
    branches[record].place = (*placed)++;
    place_ray(&records[record], branches, rays, branches[record].place);
    for (uint32_t i = first; i < end; ++i) {
        if (is_shadow(&records[i]))
            place_tree(records, i, branches, rays, placed);
    }
    for (uint32_t i = end; i-- > first;) {
        if (!is_shadow(&records[i]))
            place_tree(records, i, branches, rays, placed);
    }
}

/* False if the records do not make a tree, or the end of a ray is not known: no kernel should leave
   such records. */
static bool count_branches(const struct gpu_probe_ray *records, uint32_t count,
                           struct branch *branches)
{
    for (uint32_t i = 0; i < count; ++i) {
        uint32_t parent = records[i].parent;
        if (records[i].end == PROBE_DEFERRED || (i == 0) != (parent == PROBE_RAYS_MAX) ||
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

static int compare_values(const void *a, const void *b)
{
    const struct probe_value *x = a, *y = b;
    if (x->call != y->call)
        return x->call < y->call ? -1 : 1;
    if (x->ray != y->ray)
        return x->ray < y->ray ? -1 : 1;
    return (x->traced.order > y->traced.order) - (x->traced.order < y->traced.order);
}

/* Sorts values by rays of the tree, since ids differ from run to run; drops values of rays that are
   not in it. */
static void order_values(const struct branch *branches, const uint32_t *places,
                         struct probe_report *report)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < report->value_count; ++i) {
        struct probe_value value = report->values[i];
        uint32_t id = value.traced.id;
        uint32_t record = id < PROBE_RAYS_MAX ? places[id] : HIT_NONE;
        if (record >= report->ray_count)
            continue;
        value.ray = branches[record].place;
        report->values[kept++] = value;
    }
    report->value_count = kept;
    if (kept)
        qsort(report->values, kept, sizeof *report->values, compare_values);
}

static whit_result order_rays(const struct renderer *renderer, const struct record_list *list,
                              struct probe_report *report)
{
    const struct gpu_probe_ray *records = list->records;
    uint32_t count = report->ray_count, placed = 0;
    struct branch *branches = calloc(count ? count : 1, sizeof *branches);
    report->rays = array_alloc(count, sizeof *report->rays);
    whit_result result = WHIT_OK;
    if (!branches || !report->rays) {
        result = render_no_memory(renderer, "probed rays");
    } else if (!count_branches(records, count, branches)) {
        result = log_failure(&renderer->log, WHIT_ERROR_STATUS,
                             "the rays of pixel %u,%u do not make a tree", report->x, report->y);
    } else if (count > 0) {
        place_tree(records, 0, branches, report->rays, &placed);
    }
    if (result == WHIT_OK)
        order_values(branches, list->places, report);
    free(branches);
    return result;
}

static whit_result check(const struct renderer *renderer, uint32_t x, uint32_t y)
{
    const whit_renderer_params *params = &renderer->params;
    if (x < params->width && y < params->height) {
        if (!renderer->between_times && !renderer->between_views)
            return WHIT_OK;
        return log_usage(&renderer->log,
                         "its time or view could not be set, so there is nothing to probe");
    }
    return log_usage(&renderer->log,
                     "pixel %u,%u is outside of the picture, whose pixels are 0,0 to %u,%u", x, y,
                     params->width - 1, params->height - 1);
}

whit_result renderer_probe(struct renderer *renderer, uint32_t x, uint32_t y, uint32_t max,
                           struct probe_report *out)
{
    const whit_renderer_params *params = &renderer->params;
    struct record_list list = {0};
    *out = (struct probe_report){.x = x,
                                 .y = y,
                                 .light_samples = renderer->frame.light_samples,
                                 .samples = params->sampling.count};
    whit_result result = views_leave(renderer);
    if (result == WHIT_OK)
        result = check(renderer, x, y);
    if (result == WHIT_OK)
        result = readback_check_first(renderer, "the rays of a pixel");
    if (result == WHIT_OK)
        result = params_check_loops(renderer);
    if (result == WHIT_OK)
        result = run(renderer, max > 0 && max < PROBE_RAYS_MAX ? max : PROBE_RAYS_MAX, out, &list);
    if (result == WHIT_OK)
        result = order_rays(renderer, &list, out);
    if (result == WHIT_OK)
        result = probe_ask_twin(renderer, out);
    free(list.records);
    free(list.places);
    if (result != WHIT_OK)
        probe_report_finish(out);
    return result;
}

void probe_report_finish(struct probe_report *report)
{
    free(report->rays);
    free(report->values);
    *report = (struct probe_report){0};
}

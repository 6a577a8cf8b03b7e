/* Surface area heuristic over every position on three axes. The primitives are sorted once along
   each axis; a node sweeps its run of each list, and a split keeps the order of all three (Wald and
   Havran 2006, "On building fast kd-trees for ray tracing, and on doing that in O(N log N)", 4.3,
   for boxes that are not split). */
#include <stdlib.h>

#include "base/array.h"
#include "base/threads.h"
#include "bvh/build.h"
#include "bvh/records.h"
#include "bvh/sweep_small.h"
#include "bvh/topdown.h"

enum { THREADED_MIN = 4096 }; /* in nodes of so many records the three axes are swept by threads */

struct sweep {
    const struct build_record *records; /* [primitive] */
    uint32_t *list[3]; /* primitives in the order of their centroids, equal ones by number */
    /* For each primitive: 1 if it goes left, else 0; in a small subtree, its index there. */
    uint8_t *mark;
};

/* ---- Sorting ---- */

enum { DIGIT_BITS = 11, DIGITS = 3, BUCKETS = 1 << DIGIT_BITS };

struct sorting {
    struct sweep *sweep;
    uint32_t count;
    bool failed[3];
};

static uint32_t digit_of(uint64_t item, uint32_t digit)
{
    return (uint32_t)(item >> (32 + digit * DIGIT_BITS)) & (BUCKETS - 1);
}

static void items_make(const struct sorting *sorting, uint32_t axis, uint64_t *items,
                       uint32_t (*histogram)[BUCKETS])
{
    for (uint32_t i = 0; i < sorting->count; ++i) {
        float centroid = build_centroid_along(&sorting->sweep->records[i], axis);
        items[i] = (uint64_t)build_ordered_bits(centroid) << 32 | i;
        for (uint32_t d = 0; d < DIGITS; ++d)
            ++histogram[d][digit_of(items[i], d)];
    }
}

static void items_scatter(const uint64_t *from, uint64_t *to, uint32_t count, uint32_t digit,
                          uint32_t *histogram)
{
    uint32_t place = 0;
    for (uint32_t b = 0; b < BUCKETS; ++b) {
        uint32_t size = histogram[b];
        histogram[b] = place;
        place += size;
    }
    for (uint32_t i = 0; i < count; ++i)
        to[histogram[digit_of(from[i], digit)]++] = from[i];
}

/* Radix sort, least significant digit first: stable. */
static void sort_axis(void *user, uint32_t axis)
{
    struct sorting *sorting = user;
    uint32_t count = sorting->count, histogram[DIGITS][BUCKETS];
    uint64_t *const begin = array_alloc(2 * (size_t)count, sizeof *begin);
    if (!begin) {
        sorting->failed[axis] = true;
        return;
    }
    uint64_t *items = begin, *other = begin + count;
    memset(histogram, 0, sizeof histogram);
    items_make(sorting, axis, items, histogram);
    for (uint32_t d = 0; d < DIGITS; ++d) {
        items_scatter(items, other, count, d, histogram[d]);
        uint64_t *swapped = items;
        items = other;
        other = swapped;
    }
    for (uint32_t i = 0; i < count; ++i)
        sorting->sweep->list[axis][i] = (uint32_t)items[i];
    free(begin);
}

/* ---- Sweeping ---- */

struct cut {
    uint32_t left_count;
    float cost;
    struct build_box left;
};

struct node_sweep {
    const struct sweep *sweep;
    const struct build_range *range;
    f4 scale;
    float *right_cost[3];
    struct cut best[3];
};

/* Finds the best plane along one axis; there is none between equal centroids. */
static void sweep_axis(void *user, uint32_t axis)
{
    struct node_sweep *n = user;
    const struct build_record *records = n->sweep->records;
    const uint32_t *list = n->sweep->list[axis] + n->range->first;
    uint32_t count = n->range->count;
    float *right_cost = n->right_cost[axis];
    struct build_box side = build_box_empty();
    struct cut best = {0, INFINITY, side};
    for (uint32_t i = count - 1; i > 0; --i) {
        side = build_box_unite(side, build_record_box(&records[list[i]]));
        right_cost[i] = build_area(side, n->scale) * (float)(count - i);
    }
    side = build_box_empty();
    float before = build_centroid_along(&records[list[0]], axis);
    for (uint32_t i = 1; i < count; ++i) {
        side = build_box_unite(side, build_record_box(&records[list[i - 1]]));
        float cost = build_area(side, n->scale) * (float)i + right_cost[i];
        float key = build_centroid_along(&records[list[i]], axis);
        if (cost < best.cost && before < key)
            best = (struct cut){i, cost, side};
        before = key;
    }
    n->best[axis] = best;
}

struct parting {
    const struct sweep *sweep;
    const struct build_range *range;
    uint32_t axis, left_count;
    uint32_t *right[3];
};

/* Parts one axis's list into a left and a right run, which keep their order. */
static void part_axis(void *user, uint32_t axis)
{
    const struct parting *p = user;
    if (axis == p->axis)
        return;
    const uint8_t *mark = p->sweep->mark;
    uint32_t *list = p->sweep->list[axis] + p->range->first, *right = p->right[axis];
    uint32_t left_count = 0, right_count = 0;
    for (uint32_t i = 0; i < p->range->count; ++i) {
        uint32_t item = list[i], left = mark[item];
        list[left_count] = item;
        right[right_count] = item;
        left_count += left;
        right_count += 1 - left;
    }
    memcpy(list + left_count, right, right_count * sizeof *list);
}

/* `scratch` may be overwritten: the costs that sweeping left in it are no longer needed. */
static void part(const struct sweep *sweep, const struct build_range *range, uint32_t axis,
                 uint32_t left_count, uint32_t thread_count, void *scratch,
                 struct build_halves *halves)
{
    struct parting parting = {sweep, range, axis, left_count, {NULL}};
    const uint32_t *list = sweep->list[axis] + range->first;
    for (uint32_t i = 0; i < range->count; ++i)
        sweep->mark[list[i]] = i < left_count;
    for (uint32_t a = 0; a < 3; ++a)
        parting.right[a] = (uint32_t *)scratch + a * (size_t)range->count;
    threads_for(range->count < THREADED_MIN ? 1 : thread_count, 3, part_axis, &parting);
    halves->count[0] = left_count;
    halves->count[1] = range->count - left_count;
}

/* The box of positions [begin, end) of the range along an axis. Bounds of centroids stay empty, as
   they are not used. */
static struct build_bounds run_bounds(const struct sweep *sweep, const struct build_range *range,
                                      uint32_t axis, uint32_t begin, uint32_t end)
{
    const uint32_t *list = sweep->list[axis] + range->first;
    struct build_bounds bounds = build_bounds_empty();
    for (uint32_t i = begin; i < end; ++i)
        bounds.box = build_box_unite(bounds.box, build_record_box(&sweep->records[list[i]]));
    return bounds;
}

static enum build_choice split(const struct builder *builder, const struct build_range *range,
                               uint32_t thread_count, void *scratch, struct build_halves *halves)
{
    const struct sweep *sweep = builder->context;
    struct node_sweep n = {.sweep = sweep, .range = range, .scale = build_scale(range->bounds.box)};
    float area = build_area(range->bounds.box, n.scale);
    for (uint32_t a = 0; a < 3; ++a) {
        n.right_cost[a] = (float *)scratch + a * (size_t)range->count;
        n.best[a].cost = INFINITY;
    }
    if (area > 0.0f)
        threads_for(range->count < THREADED_MIN ? 1 : thread_count, 3, sweep_axis, &n);
    uint32_t axis = n.best[1].cost < n.best[0].cost ? 1 : 0;
    axis = n.best[2].cost < n.best[axis].cost ? 2 : axis;
    const struct cut *best = &n.best[axis];
    if (build_leaf_pays(builder->params, range->count, area, best->cost))
        return BUILD_LEAF;
    if (!(best->cost < INFINITY))
        return BUILD_NONE;
    halves->bounds[0] = (struct build_bounds){best->left, build_box_empty()};
    halves->bounds[1] = run_bounds(sweep, range, axis, best->left_count, range->count);
    part(sweep, range, axis, best->left_count, thread_count, scratch, halves);
    return BUILD_SPLIT;
}

static void halve(const struct builder *builder, const struct build_range *range, void *scratch,
                  struct build_halves *halves)
{
    const struct sweep *sweep = builder->context;
    f4 extent = f4_splat(0.0f);
    for (uint32_t a = 0; a < 3; ++a) {
        const uint32_t *list = sweep->list[a] + range->first;
        extent[a] = build_centroid_along(&sweep->records[list[range->count - 1]], a) -
                    build_centroid_along(&sweep->records[list[0]], a);
    }
    uint32_t axis = build_widest_axis(extent), left = range->count / 2;
    halves->bounds[0] = run_bounds(sweep, range, axis, 0, left);
    halves->bounds[1] = run_bounds(sweep, range, axis, left, range->count);
    part(sweep, range, axis, left, 1, scratch, halves);
}

static void grow_small(const struct builder *builder, const struct build_output *output,
                       const struct build_range *range)
{
    const struct sweep *sweep = builder->context;
    uint32_t *list[3], own[BUILD_SMALL];
    struct small small;
    for (uint32_t a = 0; a < 3; ++a)
        list[a] = sweep->list[a] + range->first;
    for (uint32_t i = 0; i < range->count; ++i) {
        own[i] = list[0][i];
        sweep->mark[own[i]] = (uint8_t)i;
        small_put(&small, i, &sweep->records[own[i]]);
    }
    for (uint32_t a = 0; a < 3; ++a) {
        for (uint32_t i = 0; i < range->count; ++i)
            small.order[0][a][i] = sweep->mark[list[a][i]];
    }
    small_grow(&small, builder, output, range);
    for (uint32_t i = 0; i < range->count; ++i)
        list[0][i] = own[small.leaves[i]];
}

/* ---- The builder ---- */

static whit_result sweep_prepare(const whit_log *log, struct sweep *sweep, uint32_t count,
                                 uint32_t thread_count)
{
    struct sorting sorting = {.sweep = sweep, .count = count};
    sweep->mark = array_alloc(count, sizeof *sweep->mark);
    bool allocated = sweep->mark != NULL;
    for (uint32_t a = 0; a < 3; ++a) {
        sweep->list[a] = array_alloc(count, sizeof *sweep->list[a]);
        allocated &= sweep->list[a] != NULL;
    }
    if (allocated)
        threads_for(count < THREADED_MIN ? 1 : thread_count, 3, sort_axis, &sorting);
    if (allocated && !sorting.failed[0] && !sorting.failed[1] && !sorting.failed[2])
        return WHIT_OK;
    return log_failure(log, WHIT_ERROR_MEMORY, "tree over %u boxes: out of memory", count);
}

whit_result sweep_build(const whit_log *log, const struct bvh_box *boxes, uint32_t count,
                        const struct bvh_triangles *triangles, const whit_accel_params *resolved,
                        struct bvh *out)
{
    (void)triangles;
    struct sweep sweep = {.mark = NULL};
    struct builder builder = {.params = resolved,
                              .context = &sweep,
                              .split = split,
                              .threaded = true,
                              .halve = halve,
                              .small = grow_small,
                              .small_count = BUILD_SMALL};
    struct build_bounds bounds;
    whit_result result =
        records_make(log, boxes, count, 0, resolved->threads, &builder.records, &bounds);
    sweep.records = builder.records;
    if (result == WHIT_OK)
        result = sweep_prepare(log, &sweep, count, resolved->threads);
    if (result == WHIT_OK)
        result = topdown_grow(log, &builder, &bounds, count, 0, out);
    if (result == WHIT_OK)
        memcpy(out->order, sweep.list[0], count * sizeof *out->order);
    free(builder.records);
    free(sweep.mark);
    for (uint32_t a = 0; a < 3; ++a)
        free(sweep.list[a]);
    return result;
}

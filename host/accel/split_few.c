/* Surface area heuristic over every position, for ranges so small that clearing bins would cost
   more than the boxes in them. Most ranges are: half of all nodes are leaves. */
#include <math.h>

#include "accel/build.h"

struct few {
    f4 lo[BUILD_FEW], hi[BUILD_FEW];
    alignas(16) float centroid[BUILD_FEW][4];
    uint8_t order[3][BUILD_FEW];
};

struct cut {
    uint32_t axis, left_count;
    float cost;
};

static void few_load(const struct build_record *records, uint32_t count, struct few *few)
{
    for (uint32_t i = 0; i < count; ++i) {
        few->lo[i] = build_record_lo(&records[i]);
        few->hi[i] = build_record_hi(&records[i]);
        f4_store(few->centroid[i], build_centroid(few->lo[i], few->hi[i]));
    }
}

/* By centroid, equal ones by primitive. */
static void few_sort(const struct build_record *records, uint32_t count, uint32_t axis,
                     struct few *few)
{
    uint8_t *order = few->order[axis];
    for (uint32_t i = 0; i < count; ++i) {
        float key = few->centroid[i][axis];
        uint32_t at = i;
        for (; at > 0; --at) {
            float before = few->centroid[order[at - 1]][axis];
            if (before < key ||
                (before == key && records[order[at - 1]].primitive < records[i].primitive))
                break;
            order[at] = order[at - 1];
        }
        order[at] = (uint8_t)i;
    }
}

static void few_sweep(const struct few *few, uint32_t count, uint32_t axis, f4 scale,
                      struct cut *best)
{
    const uint8_t *order = few->order[axis];
    if (few->centroid[order[0]][axis] == few->centroid[order[count - 1]][axis])
        return;
    float right_cost[BUILD_FEW];
    f4 lo = few->lo[order[count - 1]], hi = few->hi[order[count - 1]];
    for (uint32_t i = count - 1; i > 0; --i) {
        lo = f4_min(lo, few->lo[order[i]]);
        hi = f4_max(hi, few->hi[order[i]]);
        right_cost[i] = build_scaled_area(lo, hi, scale) * (float)(count - i);
    }
    lo = few->lo[order[0]], hi = few->hi[order[0]];
    for (uint32_t i = 1; i < count; ++i) {
        float cost = build_scaled_area(lo, hi, scale) * (float)i + right_cost[i];
        if (cost < best->cost)
            *best = (struct cut){axis, i, cost};
        lo = f4_min(lo, few->lo[order[i]]);
        hi = f4_max(hi, few->hi[order[i]]);
    }
}

static void few_apply(struct build_record *records, uint32_t count, const struct few *few,
                      const struct cut *cut, struct build_bounds halves[2])
{
    struct build_record sorted[BUILD_FEW];
    halves[0] = halves[1] = build_bounds_empty();
    for (uint32_t i = 0; i < count; ++i) {
        uint32_t from = few->order[cut->axis][i];
        sorted[i] = records[from];
        build_bounds_add(&halves[i >= cut->left_count], few->lo[from], few->hi[from]);
    }
    for (uint32_t i = 0; i < count; ++i)
        records[i] = sorted[i];
}

enum build_choice split_few(struct build_record *records, const struct build_range *range,
                            const struct bvh_params *params, uint32_t *left_count,
                            struct build_bounds halves[2])
{
    struct build_record *own = records + range->first;
    uint32_t count = range->count;
    f4 scale = build_area_scale(&range->bounds);
    float area = build_scaled_area(range->bounds.lo, range->bounds.hi, scale);
    struct few few;
    struct cut best = {.cost = INFINITY};
    if (area > 0.0f) {
        few_load(own, count, &few);
        for (uint32_t axis = 0; axis < 3; ++axis) {
            few_sort(own, count, axis, &few);
            few_sweep(&few, count, axis, scale, &best);
        }
    }
    if (count <= params->leaf_limit &&
        area * (float)count <= area * params->traversal_cost + best.cost)
        return BUILD_LEAF;
    if (!(best.cost < INFINITY))
        return BUILD_NONE;
    few_apply(own, count, &few, &best, halves);
    *left_count = best.left_count;
    return BUILD_SPLIT;
}

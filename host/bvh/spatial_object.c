/* Object splits: every reference in one half, as it is. Over all positions where there are few,
   else over equal bins (Wald 2007, "On fast construction of SAH-based bounding volume
   hierarchies"). */
#include <math.h>
#include <string.h>

#include "bvh/spatial.h"

enum { BINS = 16, FEW = 16 };

struct bin {
    f4 lo, hi;
};

static inline void bin_add(struct bin *bin, f4 lo, f4 hi)
{
    bin->lo = f4_min(bin->lo, lo);
    bin->hi = f4_max(bin->hi, hi);
}

static inline f4 record_centroid(const struct build_record *record)
{
    return build_centroid(build_record_lo(record), build_record_hi(record));
}

/* ---- Few: sorted ---- */

struct few {
    f4 lo[FEW], hi[FEW];
    alignas(16) float centroid[FEW][4];
    uint8_t order[3][FEW];
};

static void few_load(const struct build_record *records, uint32_t count, struct few *few)
{
    for (uint32_t i = 0; i < count; ++i) {
        few->lo[i] = build_record_lo(&records[i]);
        few->hi[i] = build_record_hi(&records[i]);
        f4_store(few->centroid[i], build_centroid(few->lo[i], few->hi[i]));
    }
}

/* Sorts by centroid, and equal centroids by primitive, which are all different. */
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
                      struct object_plane *best)
{
    const uint8_t *order = few->order[axis];
    if (few->centroid[order[0]][axis] == few->centroid[order[count - 1]][axis])
        return;
    struct bin right[FEW], left = {few->lo[order[0]], few->hi[order[0]]};
    right[count - 1] = (struct bin){few->lo[order[count - 1]], few->hi[order[count - 1]]};
    for (uint32_t i = count - 2; i > 0; --i) {
        right[i] = right[i + 1];
        bin_add(&right[i], few->lo[order[i]], few->hi[order[i]]);
    }
    for (uint32_t i = 1; i < count; ++i) {
        float cost = build_scaled_area(left.lo, left.hi, scale) * (float)i +
                     build_scaled_area(right[i].lo, right[i].hi, scale) * (float)(count - i);
        if (cost < best->cost) {
            best->cost = cost;
            best->axis = axis;
            best->left_count = i;
            best->overlap_lo = f4_max(left.lo, right[i].lo);
            best->overlap_hi = f4_min(left.hi, right[i].hi);
        }
        bin_add(&left, few->lo[order[i]], few->hi[order[i]]);
    }
}

static void few_find(const struct build_record *records, uint32_t count, f4 scale,
                     struct object_plane *best)
{
    struct few few;
    few_load(records, count, &few);
    for (uint32_t axis = 0; axis < 3; ++axis) {
        few_sort(records, count, axis, &few);
        few_sweep(&few, count, axis, scale, best);
    }
}

static void few_apply(struct build_record *records, uint32_t count,
                      const struct object_plane *plane, struct build_bounds halves[2])
{
    struct few few;
    struct build_record sorted[FEW];
    few_load(records, count, &few);
    few_sort(records, count, plane->axis, &few);
    for (uint32_t i = 0; i < count; ++i) {
        sorted[i] = records[few.order[plane->axis][i]];
        build_bounds_add(&halves[i >= plane->left_count], build_record_lo(&sorted[i]),
                         build_record_hi(&sorted[i]));
    }
    memcpy(records, sorted, count * sizeof *records);
}

/* ---- Many: in bins ---- */

struct bins {
    struct bin axis[3][BINS];
    uint32_t count[3][BINS];
};

/* Extents too small to be inverted count as none: that axis has one bin. */
static float axis_scale(float extent)
{
    return extent > 1e-35f ? (float)BINS * (1.0f - 1e-5f) / extent : 0.0f;
}

static inline f4 bin_position(const struct object_plane *plane, f4 centroid)
{
    return f4_min(f4_mul(f4_sub(centroid, plane->origin), plane->bins_per_unit),
                  f4_splat((float)(BINS - 1)));
}

static void bins_fill(struct bins *bins, const struct object_plane *plane,
                      const struct build_record *records, uint32_t count)
{
    const struct build_bounds empty = build_bounds_empty();
    for (int a = 0; a < 3; ++a) {
        for (int i = 0; i < BINS; ++i)
            bins->axis[a][i] = (struct bin){empty.lo, empty.hi};
    }
    memset(bins->count, 0, sizeof bins->count);
    for (uint32_t i = 0; i < count; ++i) {
        f4 lo = build_record_lo(&records[i]), hi = build_record_hi(&records[i]);
        alignas(16) int at[4];
        f4_truncate(bin_position(plane, build_centroid(lo, hi)), at);
        for (int a = 0; a < 3; ++a) {
            bin_add(&bins->axis[a][at[a]], lo, hi);
            ++bins->count[a][at[a]];
        }
    }
}

/* Where centroids differ, the smallest is in the first bin and the largest in the last, so neither
   side is ever empty. */
static void bins_sweep(const struct bins *bins, uint32_t axis, uint32_t count, f4 scale,
                       struct object_plane *best)
{
    const struct bin *bin = bins->axis[axis];
    if (bins->count[axis][0] == count)
        return;
    struct bin right[BINS], left = bin[0];
    right[BINS - 1] = bin[BINS - 1];
    for (int i = BINS - 2; i > 0; --i) {
        right[i] = right[i + 1];
        bin_add(&right[i], bin[i].lo, bin[i].hi);
    }
    uint32_t before = 0;
    for (int i = 1; i < BINS; ++i) {
        before += bins->count[axis][i - 1];
        float cost = build_scaled_area(left.lo, left.hi, scale) * (float)before +
                     build_scaled_area(right[i].lo, right[i].hi, scale) * (float)(count - before);
        if (cost < best->cost) {
            best->cost = cost;
            best->axis = axis;
            best->bin = (float)i;
            best->left_count = before;
            best->overlap_lo = f4_max(left.lo, right[i].lo);
            best->overlap_hi = f4_min(left.hi, right[i].hi);
        }
        bin_add(&left, bin[i].lo, bin[i].hi);
    }
}

static void bins_find(const struct build_record *records, const struct build_bounds *bounds,
                      uint32_t count, f4 scale, struct object_plane *best)
{
    alignas(16) float extent[4];
    f4_store(extent, f4_sub(bounds->centroid_hi, bounds->centroid_lo));
    best->origin = bounds->centroid_lo;
    best->bins_per_unit =
        f4_set(axis_scale(extent[0]), axis_scale(extent[1]), axis_scale(extent[2]), 0.0f);
    struct bins bins;
    bins_fill(&bins, best, records, count);
    for (uint32_t axis = 0; axis < 3; ++axis)
        bins_sweep(&bins, axis, count, scale, best);
}

static void bins_apply(struct build_record *records, uint32_t count,
                       const struct object_plane *plane, struct build_bounds halves[2])
{
    f4 limit = f4_splat(plane->bin);
    uint32_t i = 0, j = count;
    while (i < j) {
        f4 position = bin_position(plane, record_centroid(&records[i]));
        bool left = f4_below(position, limit) >> plane->axis & 1u;
        build_bounds_add(&halves[!left], build_record_lo(&records[i]),
                         build_record_hi(&records[i]));
        if (left) {
            ++i;
            continue;
        }
        struct build_record moved = records[--j];
        records[j] = records[i];
        records[i] = moved;
    }
}

/* ---- Both ---- */

bool object_find(const struct build_record *records, const struct build_bounds *bounds,
                 uint32_t count, f4 scale, struct object_plane *plane)
{
    plane->cost = INFINITY;
    if (!(build_scaled_area(bounds->lo, bounds->hi, scale) > 0.0f))
        return false;
    if (count <= FEW)
        few_find(records, count, scale, plane);
    else
        bins_find(records, bounds, count, scale, plane);
    return plane->cost < INFINITY;
}

void object_apply(struct build_record *records, uint32_t count, const struct object_plane *plane,
                  struct build_bounds halves[2])
{
    halves[0] = halves[1] = build_bounds_empty();
    if (count <= FEW)
        few_apply(records, count, plane, halves);
    else
        bins_apply(records, count, plane, halves);
}

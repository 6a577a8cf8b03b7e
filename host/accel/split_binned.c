/* Surface area heuristic over equal bins (Wald 2007, "On fast construction of SAH-based bounding
   volume hierarchies"), all three axes in one pass over the records. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "accel/build.h"
#include "base/array.h"
#include "base/threads.h"

enum { BINS_MAX = 256, CHUNKS_MAX = 16, CHUNK_LEAST = 4096 };

/* Bin of a centroid: (centroid - origin) * scale, truncated. Partitioning evaluates the very same
   expression, so a record never lands on the other side of where it was counted. */
struct grid {
    f4 origin, scale, last;
    uint32_t bins;
};

struct bin {
    f4 lo, hi;
};

struct bins {
    struct bin axis[3][BINS_MAX];
    uint32_t count[3][BINS_MAX];
};

struct plane {
    uint32_t axis, bin; /* records of bins below `bin` go left */
    uint32_t left_count;
    float cost; /* relative to one primitive of the node's scaled area */
};

/* Extents too small to be inverted count as none: that axis has one bin. */
static float axis_scale(float extent, uint32_t bins)
{
    return extent > 1e-35f ? (float)bins * (1.0f - 1e-5f) / extent : 0.0f;
}

static struct grid grid_over(const struct build_bounds *bounds, uint32_t bins)
{
    alignas(16) float e[4];
    f4_store(e, f4_sub(bounds->centroid_hi, bounds->centroid_lo));
    return (struct grid){
        .origin = bounds->centroid_lo,
        .scale = f4_set(axis_scale(e[0], bins), axis_scale(e[1], bins), axis_scale(e[2], bins), 0),
        .last = f4_splat((float)(bins - 1)),
        .bins = bins,
    };
}

static inline f4 grid_position(const struct grid *grid, f4 centroid)
{
    return f4_min(f4_mul(f4_sub(centroid, grid->origin), grid->scale), grid->last);
}

static void bins_clear(struct bins *bins, uint32_t count)
{
    struct build_bounds empty = build_bounds_empty();
    for (uint32_t a = 0; a < 3; ++a) {
        for (uint32_t i = 0; i < count; ++i)
            bins->axis[a][i] = (struct bin){empty.lo, empty.hi};
        memset(bins->count[a], 0, count * sizeof bins->count[a][0]);
    }
}

static inline void bin_add(struct bin *bin, f4 lo, f4 hi)
{
    bin->lo = f4_min(bin->lo, lo);
    bin->hi = f4_max(bin->hi, hi);
}

static void bins_fill(struct bins *bins, const struct grid *grid,
                      const struct build_record *records, uint32_t count)
{
    bins_clear(bins, grid->bins);
    for (uint32_t i = 0; i < count; ++i) {
        f4 lo = build_record_lo(&records[i]), hi = build_record_hi(&records[i]);
        alignas(16) int at[4];
        f4_truncate(grid_position(grid, build_centroid(lo, hi)), at);
        bin_add(&bins->axis[0][at[0]], lo, hi);
        bin_add(&bins->axis[1][at[1]], lo, hi);
        bin_add(&bins->axis[2][at[2]], lo, hi);
        ++bins->count[0][at[0]];
        ++bins->count[1][at[1]];
        ++bins->count[2][at[2]];
    }
}

struct chunks {
    const struct grid *grid;
    const struct build_record *records;
    uint32_t count, chunk_count;
    struct bins *bins;
};

static void fill_chunk(void *context, uint32_t index)
{
    const struct chunks *c = context;
    uint32_t begin = (uint32_t)((uint64_t)c->count * index / c->chunk_count);
    uint32_t end = (uint32_t)((uint64_t)c->count * (index + 1) / c->chunk_count);
    bins_fill(&c->bins[index], c->grid, c->records + begin, end - begin);
}

/* Minimum, maximum and integer sums do not depend on how the records are cut into chunks. */
static void bins_fill_threaded(struct bins *bins, const struct grid *grid,
                               const struct build_record *records, uint32_t count,
                               uint32_t thread_count)
{
    uint32_t chunk_count = thread_count < CHUNKS_MAX ? thread_count : CHUNKS_MAX;
    struct bins *parts =
        count / CHUNK_LEAST >= chunk_count ? array_alloc_aligned(chunk_count, sizeof *parts) : NULL;
    if (!parts) {
        bins_fill(bins, grid, records, count);
        return;
    }
    struct chunks chunks = {grid, records, count, chunk_count, parts};
    threads_for(thread_count, chunk_count, fill_chunk, &chunks);
    bins_clear(bins, grid->bins);
    for (uint32_t p = 0; p < chunk_count; ++p) {
        for (uint32_t a = 0; a < 3; ++a) {
            for (uint32_t i = 0; i < grid->bins; ++i) {
                bin_add(&bins->axis[a][i], parts[p].axis[a][i].lo, parts[p].axis[a][i].hi);
                bins->count[a][i] += parts[p].count[a][i];
            }
        }
    }
    free(parts);
}

/* Where centroids differ, the smallest is in the first bin and the largest in the last, so neither
   side is ever empty; bins without records change nothing. */
static void sweep_axis(const struct bins *bins, uint32_t bin_count, uint32_t count, f4 scale,
                       uint32_t axis, struct plane *best)
{
    const struct bin *bin = bins->axis[axis];
    const uint32_t *in = bins->count[axis];
    if (in[0] == count)
        return;
    float right_cost[BINS_MAX];
    struct bin sum = bin[bin_count - 1];
    uint32_t right = 0;
    for (uint32_t i = bin_count - 1; i > 0; --i) {
        bin_add(&sum, bin[i].lo, bin[i].hi);
        right += in[i];
        right_cost[i] = build_scaled_area(sum.lo, sum.hi, scale) * (float)right;
    }
    sum = bin[0];
    uint32_t left = 0;
    for (uint32_t i = 1; i < bin_count; ++i) {
        bin_add(&sum, bin[i - 1].lo, bin[i - 1].hi);
        left += in[i - 1];
        float cost = build_scaled_area(sum.lo, sum.hi, scale) * (float)left + right_cost[i];
        if (cost < best->cost)
            *best = (struct plane){axis, i, left, cost};
    }
}

/* The boxes on both sides of the plane are unions of bins: exact. */
static void halves_from_bins(const struct bins *bins, uint32_t bin_count, const struct plane *plane,
                             struct build_bounds halves[2])
{
    for (uint32_t i = 0; i < bin_count; ++i) {
        const struct bin *bin = &bins->axis[plane->axis][i];
        struct build_bounds *half = &halves[i >= plane->bin];
        half->lo = f4_min(half->lo, bin->lo);
        half->hi = f4_max(half->hi, bin->hi);
    }
}

static void partition(struct build_record *records, uint32_t count, const struct grid *grid,
                      const struct plane *plane, struct build_bounds halves[2])
{
    f4 limit = f4_splat((float)plane->bin);
    uint32_t i = 0, j = count;
    while (i < j) {
        f4 centroid = build_centroid(build_record_lo(&records[i]), build_record_hi(&records[i]));
        bool left = f4_below(grid_position(grid, centroid), limit) >> plane->axis & 1u;
        struct build_bounds *half = &halves[!left];
        half->centroid_lo = f4_min(half->centroid_lo, centroid);
        half->centroid_hi = f4_max(half->centroid_hi, centroid);
        if (left) {
            ++i;
        } else {
            --j;
            struct build_record moved = records[j];
            records[j] = records[i];
            records[i] = moved;
        }
    }
}

enum build_choice split_binned(struct build_record *records, const struct build_range *range,
                               const struct bvh_params *params, uint32_t thread_count,
                               uint32_t *left_count, struct build_bounds halves[2])
{
    struct build_record *own = records + range->first;
    uint32_t bin_count = params->bins;
    struct grid grid = grid_over(&range->bounds, bin_count);
    struct bins bins;
    if (thread_count > 1)
        bins_fill_threaded(&bins, &grid, own, range->count, thread_count);
    else
        bins_fill(&bins, &grid, own, range->count);

    f4 scale = build_area_scale(&range->bounds);
    float area = build_scaled_area(range->bounds.lo, range->bounds.hi, scale);
    struct plane best = {.cost = INFINITY};
    if (area > 0.0f) {
        for (uint32_t axis = 0; axis < 3; ++axis)
            sweep_axis(&bins, bin_count, range->count, scale, axis, &best);
    }
    if (range->count <= params->leaf_limit &&
        area * (float)range->count <= area * params->traversal_cost + best.cost)
        return BUILD_LEAF;
    if (!(best.cost < INFINITY))
        return BUILD_NONE;
    halves[0] = halves[1] = build_bounds_empty();
    halves_from_bins(&bins, bin_count, &best, halves);
    partition(own, range->count, &grid, &best, halves);
    *left_count = best.left_count;
    return BUILD_SPLIT;
}

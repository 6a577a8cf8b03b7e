/* Surface area heuristic over equal bins (Wald 2007, "On fast construction of SAH-based bounding
   volume hierarchies"), all three axes in one pass over the records. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/threads.h"
#include "bvh/build.h"

enum {
    BINS_MAX = 256,
    FREE_BINS_MIN = 8, /* where their number is free */
    FREE_BINS_MAX = 32,
    CHUNKS_MAX = 16,
    CHUNK_MIN = 4096,
};

/* Bin of a centroid: (centroid - origin) * scale, truncated. Partitioning evaluates the very same
   expression, so a record never lands on the other side of where it was counted. */
struct grid {
    f4 origin, scale, last;
    uint32_t bins;
};

struct bin {
    f4 lo, hi;
};

/* Bins of the three axes side by side: they are swept as the lanes of one vector. */
struct bins {
    struct bin box[BINS_MAX][3];
    alignas(16) uint32_t count[BINS_MAX][4];
};

struct plane {
    uint32_t axis, bin; /* records of bins below `bin` go left */
    float cost;         /* relative to one primitive of the node's scaled area */
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
    for (uint32_t i = 0; i < count; ++i) {
        for (uint32_t a = 0; a < 3; ++a)
            bins->box[i][a] = (struct bin){empty.lo, empty.hi};
    }
    memset(bins->count, 0, count * sizeof bins->count[0]);
}

static inline void bin_add(struct bin *bin, f4 lo, f4 hi)
{
    bin->lo = f4_min(bin->lo, lo);
    bin->hi = f4_max(bin->hi, hi);
}

static inline void bins_add(struct bins *bins, const struct grid *grid,
                            const struct build_record *record)
{
    f4 lo = build_record_lo(record), hi = build_record_hi(record);
    alignas(16) int at[4];
    f4_truncate(grid_position(grid, build_centroid(lo, hi)), at);
    for (int a = 0; a < 3; ++a) {
        bin_add(&bins->box[at[a]][a], lo, hi);
        ++bins->count[at[a]][a];
    }
}

static void bins_unite(struct bins *bins, const struct bins *other, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i) {
        for (uint32_t a = 0; a < 3; ++a) {
            bin_add(&bins->box[i][a], other->box[i][a].lo, other->box[i][a].hi);
            bins->count[i][a] += other->count[i][a];
        }
    }
}

static void bins_fill(struct bins *bins, const struct grid *grid,
                      const struct build_record *records, uint32_t count)
{
    bins_clear(bins, grid->bins);
    for (uint32_t i = 0; i < count; ++i)
        bins_add(bins, grid, &records[i]);
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
        count / CHUNK_MIN >= chunk_count ? array_alloc_aligned(chunk_count, sizeof *parts) : NULL;
    if (!parts) {
        bins_fill(bins, grid, records, count);
        return;
    }
    struct chunks chunks = {grid, records, count, chunk_count, parts};
    threads_for(thread_count, chunk_count, fill_chunk, &chunks);
    bins_clear(bins, grid->bins);
    for (uint32_t p = 0; p < chunk_count; ++p)
        bins_unite(bins, &parts[p], grid->bins);
    free(parts);
}

static inline f4 bins_areas(const struct bin sums[3], f4 scale)
{
    f4 d[3];
    for (int a = 0; a < 3; ++a)
        d[a] = f4_sub(f4_mul(sums[a].hi, scale), f4_mul(sums[a].lo, scale));
    return f4_half_areas(d[0], d[1], d[2]);
}

static inline void bins_sum(struct bin sums[3], const struct bin row[3])
{
    for (int a = 0; a < 3; ++a)
        bin_add(&sums[a], row[a].lo, row[a].hi);
}

/* Where centroids differ, the smallest is in the first bin and the largest in the last, so neither
   side is ever empty; bins without records change nothing. An axis on which they do not differ has
   everything in the first bin: empty boxes to the right of it make its costs infinite. */
static void sweep_axes(const struct bins *bins, uint32_t bin_count, f4 scale, struct plane *best)
{
    f4 right_cost[BINS_MAX], count = f4_splat(0.0f);
    f4 best_cost = f4_splat(INFINITY), best_at = f4_splat(0.0f);
    struct bin empty = {build_bounds_empty().lo, build_bounds_empty().hi};
    struct bin sums[3] = {empty, empty, empty};
    for (uint32_t i = bin_count - 1; i > 0; --i) {
        bins_sum(sums, bins->box[i]);
        count = f4_add(count, f4_from_counts(bins->count[i]));
        f4 some = f4_less(f4_splat(0.0f), count);
        f4 cost = f4_mul(bins_areas(sums, scale), count);
        right_cost[i] = f4_select(some, cost, f4_splat(INFINITY));
    }
    sums[0] = sums[1] = sums[2] = empty;
    count = f4_splat(0.0f);
    for (uint32_t i = 1; i < bin_count; ++i) {
        bins_sum(sums, bins->box[i - 1]);
        count = f4_add(count, f4_from_counts(bins->count[i - 1]));
        f4 cost = f4_add(f4_mul(bins_areas(sums, scale), count), right_cost[i]);
        f4 better = f4_less(cost, best_cost);
        best_cost = f4_select(better, cost, best_cost);
        best_at = f4_select(better, f4_splat((float)i), best_at);
    }
    alignas(16) float cost[4];
    alignas(16) int at[4];
    f4_store(cost, best_cost);
    f4_truncate(best_at, at);
    for (uint32_t a = 0; a < 3; ++a) {
        if (cost[a] < best->cost)
            *best = (struct plane){a, (uint32_t)at[a], cost[a]};
    }
}

/* The boxes on both sides of the plane are unions of bins: exact. */
static uint32_t halves_from_bins(const struct bins *bins, uint32_t bin_count,
                                 const struct plane *plane, struct build_bounds halves[2])
{
    uint32_t left_count = 0;
    for (uint32_t i = 0; i < bin_count; ++i) {
        const struct bin *bin = &bins->box[i][plane->axis];
        struct build_bounds *half = &halves[i >= plane->bin];
        half->lo = f4_min(half->lo, bin->lo);
        half->hi = f4_max(half->hi, bin->hi);
        left_count += i < plane->bin ? bins->count[i][plane->axis] : 0;
    }
    return left_count;
}

static void centroids_add(struct build_bounds *half, const struct build_record *record)
{
    f4 centroid = build_centroid(build_record_lo(record), build_record_hi(record));
    half->centroid_lo = f4_min(half->centroid_lo, centroid);
    half->centroid_hi = f4_max(half->centroid_hi, centroid);
}

/* Both sides keep their order. No branch depends on the side, which cannot be foreseen: every
   record is written to both, and one of the two is written over. */
static void partition(struct build_record *records, uint32_t count, const struct grid *grid,
                      const struct plane *plane, struct build_record *scratch,
                      struct build_bounds halves[2])
{
    f4 limit = f4_splat((float)plane->bin);
    uint32_t left_count = 0, right_count = 0;
    for (uint32_t i = 0; i < count; ++i) {
        struct build_record record = records[i];
        f4 centroid = build_centroid(build_record_lo(&record), build_record_hi(&record));
        uint32_t left = f4_below(grid_position(grid, centroid), limit) >> plane->axis & 1u;
        records[left_count] = record;
        scratch[right_count] = record;
        left_count += left;
        right_count += 1 - left;
    }
    for (uint32_t i = 0; i < left_count; ++i)
        centroids_add(&halves[0], &records[i]);
    for (uint32_t i = 0; i < right_count; ++i) {
        records[left_count + i] = scratch[i];
        centroids_add(&halves[1], &scratch[i]);
    }
}

/* More bins than boxes find nothing more, and cost more than the boxes. */
static uint32_t bins_wanted(const struct bvh_params *params, uint32_t count)
{
    uint32_t wanted = FREE_BINS_MIN + count / 16;
    return params->bins ? params->bins : wanted < FREE_BINS_MAX ? wanted : FREE_BINS_MAX;
}

enum build_choice split_binned(struct build_record *records, const struct build_range *range,
                               const struct bvh_params *params, uint32_t thread_count,
                               struct build_record *scratch, uint32_t *left_count,
                               struct build_bounds halves[2])
{
    struct build_record *own = records + range->first;
    uint32_t bin_count = bins_wanted(params, range->count);
    struct grid grid = grid_over(&range->bounds, bin_count);
    struct bins bins;
    if (thread_count > 1)
        bins_fill_threaded(&bins, &grid, own, range->count, thread_count);
    else
        bins_fill(&bins, &grid, own, range->count);

    f4 scale = build_area_scale(&range->bounds);
    float area = build_scaled_area(range->bounds.lo, range->bounds.hi, scale);
    struct plane best = {.cost = INFINITY};
    if (area > 0.0f)
        sweep_axes(&bins, bin_count, scale, &best);
    if (range->count <= params->leaf_limit &&
        area * (float)range->count <= area * params->traversal_cost + best.cost)
        return BUILD_LEAF;
    if (!(best.cost < INFINITY))
        return BUILD_NONE;
    halves[0] = halves[1] = build_bounds_empty();
    *left_count = halves_from_bins(&bins, bin_count, &best, halves);
    partition(own, range->count, &grid, &best, scratch, halves);
    return BUILD_SPLIT;
}

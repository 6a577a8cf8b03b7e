/* Surface area heuristic over equal bins (Wald 2007, "On fast construction of SAH-based bounding
   volume hierarchies"), all three axes in one pass over the records. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/threads.h"
#include "bvh/split_binned.h"

enum {
    BINS_MAX = 256,
    FREE_BINS_MIN = 8, /* for a number of bins that follows the size of the node */
    FREE_BINS_MAX = 32,
    CHUNKS_MAX = 16,
    CHUNK_MIN = 4096,
};

/* Bins of the three axes side by side: they are swept as the lanes of one vector. */
struct bins {
    struct build_box box[BINS_MAX][3];
    alignas(16) uint32_t count[BINS_MAX][4];
};

/* Bins per unit of length. Extents too small to be inverted count as 0: that axis has one bin. */
static float axis_scale(float extent, uint32_t bins)
{
    return extent > 1e-35f ? (float)bins * (1.0f - 1e-5f) / extent : 0.0f;
}

static struct bin_grid grid_over(const struct build_box *centroids, uint32_t bins)
{
    f4 e = centroids->hi - centroids->lo;
    return (struct bin_grid){
        .origin = centroids->lo,
        .scale = {axis_scale(e[0], bins), axis_scale(e[1], bins), axis_scale(e[2], bins), 0.0f},
        .last = f4_splat((float)(bins - 1)),
        .bins = bins,
    };
}

static void bins_clear(struct bins *bins, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i) {
        for (uint32_t a = 0; a < 3; ++a)
            bins->box[i][a] = build_box_empty();
    }
    memset(bins->count, 0, count * sizeof bins->count[0]);
}

static inline void bins_add(struct bins *bins, const struct bin_grid *grid,
                            const struct build_record *record)
{
    struct build_box box = build_record_box(record);
    i4 at = f4_truncate(bin_grid_position(grid, build_centroid(box)));
    for (int a = 0; a < 3; ++a) {
        bins->box[at[a]][a] = build_box_unite(bins->box[at[a]][a], box);
        ++bins->count[at[a]][a];
    }
}

static void bins_unite(struct bins *bins, const struct bins *other, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i) {
        for (uint32_t a = 0; a < 3; ++a) {
            bins->box[i][a] = build_box_unite(bins->box[i][a], other->box[i][a]);
            bins->count[i][a] += other->count[i][a];
        }
    }
}

static void bins_fill(struct bins *bins, const struct bin_grid *grid,
                      const struct build_record *records, uint32_t count)
{
    bins_clear(bins, grid->bins);
    for (uint32_t i = 0; i < count; ++i)
        bins_add(bins, grid, &records[i]);
}

struct chunks {
    const struct bin_grid *grid;
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

/* Fills the bins by several threads. Minima, maxima and integer sums do not depend on how the
   records are cut into chunks. */
static void bins_fill_threaded(struct bins *bins, const struct bin_grid *grid,
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

static inline void bins_sum(struct build_box sums[3], const struct build_box row[3])
{
    for (int a = 0; a < 3; ++a)
        sums[a] = build_box_unite(sums[a], row[a]);
}

/* Finds the best plane between bins. Where centroids differ along an axis, the smallest is in the
   first bin and the largest in the last, so neither side is ever empty; bins without records change
   nothing. Where they do not differ, all are in the first bin: the boxes right of it are empty, and
   the axis's costs infinite. */
static void sweep_axes(const struct bins *bins, uint32_t bin_count, f4 scale,
                       struct bin_plane *best)
{
    f4 right_cost[BINS_MAX], count = f4_splat(0.0f);
    f4 best_cost = f4_splat(INFINITY), best_at = f4_splat(0.0f);
    struct build_box empty = build_box_empty(), sums[3] = {empty, empty, empty};
    for (uint32_t i = bin_count - 1; i > 0; --i) {
        bins_sum(sums, bins->box[i]);
        count += f4_from_counts(bins->count[i]);
        f4 cost = build_areas(sums, scale) * count;
        right_cost[i] = f4_select(count > 0.0f, cost, f4_splat(INFINITY));
    }
    sums[0] = sums[1] = sums[2] = empty;
    count = f4_splat(0.0f);
    for (uint32_t i = 1; i < bin_count; ++i) {
        bins_sum(sums, bins->box[i - 1]);
        count += f4_from_counts(bins->count[i - 1]);
        f4 cost = build_areas(sums, scale) * count + right_cost[i];
        i4 better = cost < best_cost;
        best_cost = f4_select(better, cost, best_cost);
        best_at = f4_select(better, f4_splat((float)i), best_at);
    }
    i4 at = f4_truncate(best_at);
    for (uint32_t a = 0; a < 3; ++a) {
        if (best_cost[a] < best->cost) {
            best->axis = a;
            best->bin = (uint32_t)at[a];
            best->cost = best_cost[a];
        }
    }
}

/* The boxes on both sides of the plane are unions of bins: exact. */
static void sides_from_bins(const struct bins *bins, uint32_t bin_count, struct bin_plane *plane)
{
    plane->left_count = 0;
    plane->side[0] = plane->side[1] = build_box_empty();
    for (uint32_t i = 0; i < bin_count; ++i) {
        struct build_box *side = &plane->side[i >= plane->bin];
        *side = build_box_unite(*side, bins->box[i][plane->axis]);
        plane->left_count += i < plane->bin ? bins->count[i][plane->axis] : 0;
    }
}

void bins_find(const struct build_record *records, const struct build_range *range, uint32_t bins,
               f4 scale, uint32_t thread_count, struct bin_plane *plane)
{
    struct bins filled;
    plane->grid = grid_over(&range->bounds.centroids, bins);
    plane->cost = INFINITY;
    if (thread_count > 1)
        bins_fill_threaded(&filled, &plane->grid, records, range->count, thread_count);
    else
        bins_fill(&filled, &plane->grid, records, range->count);
    sweep_axes(&filled, bins, scale, plane);
    if (plane->cost < INFINITY)
        sides_from_bins(&filled, bins, plane);
}

/* ---- Splitting ---- */

static void centroids_add(struct build_box *centroids, const struct build_record *record)
{
    f4 centroid = build_centroid(build_record_box(record));
    *centroids = build_box_unite(*centroids, (struct build_box){centroid, centroid});
}

/* Both sides keep their order. No branch depends on the side, which a processor could not predict:
   every record is written to both sides, and one of the two copies is overwritten. */
static void partition(struct build_record *records, uint32_t count, const struct bin_plane *plane,
                      struct build_record *scratch, struct build_bounds halves[2])
{
    uint32_t left_count = 0, right_count = 0;
    for (uint32_t i = 0; i < count; ++i) {
        struct build_record record = records[i];
        uint32_t left = bin_plane_left(plane, build_centroid(build_record_box(&record)));
        records[left_count] = record;
        scratch[right_count] = record;
        left_count += left;
        right_count += 1 - left;
    }
    for (uint32_t i = 0; i < left_count; ++i)
        centroids_add(&halves[0].centroids, &records[i]);
    for (uint32_t i = 0; i < right_count; ++i) {
        records[left_count + i] = scratch[i];
        centroids_add(&halves[1].centroids, &scratch[i]);
    }
}

/* The number of bins for a node: more bins than boxes find no better plane, and cost more. */
static uint32_t bins_wanted(const whit_accel_params *params, uint32_t count)
{
    uint32_t wanted = FREE_BINS_MIN + count / 16;
    return params->bins ? params->bins : wanted < FREE_BINS_MAX ? wanted : FREE_BINS_MAX;
}

enum build_choice split_binned(const struct builder *builder, const struct build_range *range,
                               uint32_t thread_count, void *scratch, struct build_halves *halves)
{
    const whit_accel_params *params = builder->params;
    struct build_record *own = builder->records + range->first;
    f4 scale = build_scale(range->bounds.box);
    float area = build_area(range->bounds.box, scale);
    struct bin_plane plane;
    plane.cost = INFINITY;
    if (area > 0.0f)
        bins_find(own, range, bins_wanted(params, range->count), scale, thread_count, &plane);
    if (build_leaf_pays(params, range->count, area, plane.cost))
        return BUILD_LEAF;
    if (!(plane.cost < INFINITY))
        return BUILD_NONE;
    halves->count[0] = plane.left_count;
    halves->count[1] = range->count - plane.left_count;
    for (int i = 0; i < 2; ++i)
        halves->bounds[i] = (struct build_bounds){plane.side[i], build_box_empty()};
    partition(own, range->count, &plane, scratch, halves->bounds);
    return BUILD_SPLIT;
}

/* Inside of the builders: what bvh.c hands to them, and topdown.c to split_*.c. */
#ifndef BVH_BUILD_H
#define BVH_BUILD_H

#include <float.h>
#include <math.h>
#include <stdalign.h>
#include <string.h>

#include "base/vec.h"
#include "bvh/bvh.h"
#include "bvh/f4.h"

/* Builders, called by bvh_build with at least one box and parameters in which no 0 stands for a
   default, but for `bins` of BVH_BINNED: 0 lets the number follow the size of the node. They fill
   *out up to build_complete; on failure the caller releases what is in it. */
whit_result records_build(const whit_log *log, const struct bvh_box *boxes, uint32_t count,
                          const struct bvh_params *resolved, struct bvh *out);
whit_result sweep_build(const whit_log *log, const struct bvh_box *boxes, uint32_t count,
                        const struct bvh_params *resolved, struct bvh *out);
whit_result spatial_build(const whit_log *log, const struct bvh_box *boxes, uint32_t count,
                          const struct bvh_params *resolved, struct bvh *out);

/* bvh_complete by several threads: the same bits for any number of them. */
void build_complete(struct bvh *bvh, double traversal_cost, uint32_t thread_count);

/* A box with the primitive it belongs to: a reference. Records are moved, not indices to them, so
   that a subtree is one run of memory. */
struct build_record {
    alignas(32) float lo[3];
    uint32_t primitive;
    float hi[3];
    uint32_t flags; /* SPATIAL_* */
};

struct build_box {
    f4 lo, hi;
};

/* Bounds of some records. Centroids are quartered sums lo / 4 + hi / 4: neither they nor their
   differences overflow. */
struct build_bounds {
    struct build_box box, centroids;
};

/* ---- Top-down building (topdown.c) ---- */

/* Records [first, first + count) with room for `spare` more behind them, and where their subtree
   goes: node `node`, and pairs of children from pair slot `pair` on, of which it may use count +
   spare - 1. */
struct build_range {
    struct build_bounds bounds;
    uint32_t node, pair, first, count, spare, depth;
};

/* The two runs that the records of a range were split into, the second behind the first. A record
   that was split itself is in both: together they are at most count + spare. */
struct build_halves {
    struct build_bounds bounds[2];
    uint32_t count[2];
};

enum build_choice {
    BUILD_SPLIT, /* the records are in two runs */
    BUILD_LEAF,  /* a leaf costs less; allowed by the leaf limit */
    BUILD_NONE,  /* no plane separates anything */
};

/* The depth from which nodes are split at the median: 28 more levels for 2^28 primitives. */
enum { BUILD_DEPTH_OF_MEDIANS = 96 };

/* The nodes while a tree grows. Pair slot s is nodes 2 + 2 s and 3 + 2 s. */
struct build_output {
    struct gpu_bvh_node *nodes;
    uint32_t *slots; /* 1: in use; later its place when squeezed */
};

/* What differs between builders. Ranges that do not overlap are given to several threads at once.
   `scratch` is 64-byte aligned and holds 64 * (range->count - 1) bytes. */
struct builder {
    const struct bvh_params *params;
    struct build_record *records;
    void *context; /* the builder's own */
    /* With thread_count > 1, which only a `threaded` one meets, the work on this one range is to be
       spread over threads. NULL: always `halve`. */
    enum build_choice (*split)(const struct builder *builder, const struct build_range *range,
                               uint32_t thread_count, void *scratch, struct build_halves *halves);
    bool threaded;
    /* The same without a choice, and without fail: for BUILD_NONE above the leaf limit. */
    void (*halve)(const struct builder *builder, const struct build_range *range, void *scratch,
                  struct build_halves *halves);
    /* Builds the whole subtree of a range of at most small_count records. */
    void (*small)(const struct builder *builder, const struct build_output *output,
                  const struct build_range *range);
    uint32_t small_count;
};

/* Grows the tree over `count` records within `bounds`, with room for `spare` more behind them.
   Allocates out->order, for all of them, and gives out->nodes, of which leaves name runs of
   records: the order, and what follows from nodes, are the builder's to fill in. */
whit_result topdown_grow(const whit_log *log, const struct builder *builder,
                         const struct build_bounds *bounds, uint32_t count, uint32_t spare,
                         struct bvh *out);

/* Not zeroed: slots that stay empty should cost no memory. */
void *build_alloc_lines(size_t count, size_t element_bytes);

/* ---- Records (records.c) ---- */

/* In the order of the input, zeros without sign, and room for `spare` more behind them. free() */
whit_result records_make(const whit_log *log, const struct bvh_box *boxes, uint32_t count,
                         uint32_t spare, uint32_t thread_count, struct build_record **records,
                         struct build_bounds *bounds);

/* The bounds of the first halves->count[0] records, and of the rest of `count`. */
void records_bound(const struct build_record *records, uint32_t count, struct build_halves *halves);

/* ---- Equal bins (split_binned.c) ---- */

/* Bin of a centroid: (centroid - origin) * scale, truncated. Partitioning evaluates the very same
   expression, so a record never lands on the other side of where it was counted. */
struct bin_grid {
    f4 origin, scale, last;
    uint32_t bins;
};

struct bin_plane {
    struct bin_grid grid;
    uint32_t axis, bin;  /* records of bins below `bin` go left */
    float cost;          /* relative to one primitive of the node's scaled area */
    uint32_t left_count; /* and the boxes of both sides, if the cost is below infinity */
    struct build_box side[2];
};

/* The best of equally spaced planes on all axes; of infinite cost where none separates anything. */
void bins_find(const struct build_record *records, const struct build_range *range, uint32_t bins,
               f4 scale, uint32_t thread_count, struct bin_plane *plane);

static inline f4 bin_grid_position(const struct bin_grid *grid, f4 centroid)
{
    return f4_min(f4_mul(f4_sub(centroid, grid->origin), grid->scale), grid->last);
}

/* 1: a record of this centroid goes left, else 0. */
static inline uint32_t bin_plane_left(const struct bin_plane *plane, f4 centroid)
{
    f4 position = bin_grid_position(&plane->grid, centroid);
    return f4_below(position, f4_splat((float)plane->bin)) >> plane->axis & 1u;
}

/* ---- The ways to split ---- */

/* builder->split: bins_find, and partitions. */
enum build_choice split_binned(const struct builder *builder, const struct build_range *range,
                               uint32_t thread_count, void *scratch, struct build_halves *halves);

/* builder->halve: along the axis of the widest centroids; equal centroids by primitive. */
void split_median(const struct builder *builder, const struct build_range *range, void *scratch,
                  struct build_halves *halves);

/* ---- Small subtrees (sweep_small.c) ---- */

/* At most BUILD_SMALL boxes, and their order along each axis. */
enum { BUILD_SMALL = 16 };
struct small {
    struct build_box box[BUILD_SMALL];
    alignas(16) float centroid[BUILD_SMALL][4];
    uint8_t order[2][3]
                 [BUILD_SMALL];  /* nodes read one side and write the other for their children */
    uint8_t leaves[BUILD_SMALL]; /* the result: boxes leaf by leaf */
};

struct small_cut {
    uint32_t axis, left_count; /* of order[0][axis] */
    float cost;
};

void small_put(struct small *small, uint32_t index, const struct build_record *record);
/* Fills order[0]: by centroid, equal ones by position. */
void small_sort(struct small *small, uint32_t count);
/* The best cut of `count` boxes, not at infinite cost, at any position of order[0] on an axis along
   which not all are equal. */
struct small_cut small_find(const struct small *small, uint32_t count, f4 scale);
/* Grows the subtree over the boxes of `range` by sweeping over every position along order[0] that
   separates centroids. */
void small_grow(struct small *small, const struct builder *builder,
                const struct build_output *output, const struct build_range *range);

/* ---- Boxes ---- */

static inline struct build_box build_box_empty(void)
{
    return (struct build_box){f4_set(FLT_MAX, FLT_MAX, FLT_MAX, 0.0f),
                              f4_set(-FLT_MAX, -FLT_MAX, -FLT_MAX, 0.0f)};
}

static inline struct build_box build_box_unite(struct build_box a, struct build_box b)
{
    return (struct build_box){f4_min(a.lo, b.lo), f4_max(a.hi, b.hi)};
}

static inline struct build_box build_record_box(const struct build_record *r)
{
    return (struct build_box){f4_xyz(f4_load(r->lo)), f4_xyz(f4_load(r->hi))};
}

static inline struct build_box build_node_box(const struct gpu_bvh_node *node)
{
    return (struct build_box){f4_xyz(f4_load(node->lo)), f4_xyz(f4_load(node->hi))};
}

static inline void build_node_write(struct gpu_bvh_node *node, struct build_box box, uint32_t first,
                                    uint32_t count)
{
    alignas(16) float lo[4], hi[4];
    f4_store(lo, box.lo);
    f4_store(hi, box.hi);
    memcpy(node->lo, lo, sizeof node->lo);
    memcpy(node->hi, hi, sizeof node->hi);
    node->first = first;
    node->count = count;
}

static inline f4 build_centroid(struct build_box box)
{
    f4 quarter = f4_splat(0.25f);
    return f4_add(f4_mul(box.lo, quarter), f4_mul(box.hi, quarter));
}

/* The same of one axis. */
static inline float build_centroid_along(const struct build_record *record, uint32_t axis)
{
    return record->lo[axis] * 0.25f + record->hi[axis] * 0.25f;
}

static inline struct build_bounds build_bounds_empty(void)
{
    return (struct build_bounds){build_box_empty(), build_box_empty()};
}

static inline void build_bounds_add(struct build_bounds *b, const struct build_record *record)
{
    struct build_box box = build_record_box(record);
    f4 centroid = build_centroid(box);
    b->box = build_box_unite(b->box, box);
    b->centroids = build_box_unite(b->centroids, (struct build_box){centroid, centroid});
}

/* ---- Costs ---- */

/* A power of two that brings the largest extent into [0.5, 1], or near it at the ends of the range
   of floats: areas neither overflow nor vanish, whatever the scene's unit. */
static inline f4 build_scale(struct build_box box)
{
    alignas(16) float e[4];
    f4_store(e, f4_sub(box.hi, box.lo));
    float extent = e[0] > e[1] ? e[0] : e[1];
    extent = extent > e[2] ? extent : e[2];
    int exponent = (int)(float_bits(extent) >> 23) - 126;
    exponent = exponent > 126 ? 126 : exponent;
    return f4_splat(float_of_bits((uint32_t)(127 - exponent) << 23));
}

static inline float build_area(struct build_box box, f4 scale)
{
    return f4_half_area(f4_sub(f4_mul(box.hi, scale), f4_mul(box.lo, scale)));
}

/* build_area of each of the three, in the first three lanes. */
static inline f4 build_areas(const struct build_box box[3], f4 scale)
{
    f4 d[3];
    for (int a = 0; a < 3; ++a)
        d[a] = f4_sub(f4_mul(box[a].hi, scale), f4_mul(box[a].lo, scale));
    return f4_half_areas(d[0], d[1], d[2]);
}

/* Whether a leaf is allowed, and costs no more than a split of this cost. */
static inline bool build_leaf_pays(const struct bvh_params *params, uint32_t count, float area,
                                   float split_cost)
{
    return count <= params->leaf_limit &&
           area * (float)count <= area * params->traversal_cost + split_cost;
}

static inline uint32_t build_widest_axis(const float extent[3])
{
    uint32_t axis = extent[1] > extent[0] ? 1 : 0;
    return extent[2] > extent[axis] ? 2 : axis;
}

/* Floats in the order of unsigned integers. */
static inline uint32_t build_ordered_bits(float value)
{
    uint32_t bits = float_bits(value + 0.0f); /* one zero */
    return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

static inline void build_records_swap(struct build_record *a, struct build_record *b)
{
    struct build_record moved = *a;
    *a = *b;
    *b = moved;
}

#endif

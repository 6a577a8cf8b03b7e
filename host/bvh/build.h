/* Inside of the builders: what bvh.c hands to them, and topdown.c to split_*.c. */
#ifndef BVH_BUILD_H
#define BVH_BUILD_H

#include <float.h>
#include <math.h>
#include <stdalign.h>
#include <string.h>

#include "bvh/bvh.h"
#include "bvh/f4.h"

/* Builders, called by bvh_build with at least one box and parameters in which no 0 stands for a
   default, but for `bins` of BVH_BINNED: 0 lets the number follow the size of the node. They fill
   *out up to bvh_complete; on failure the caller releases what is in it. */
whit_result records_build(const struct log *log, const struct bvh_box *boxes, uint32_t count,
                          const struct bvh_params *resolved, struct bvh *out);
whit_result sweep_build(const struct log *log, const struct bvh_box *boxes, uint32_t count,
                        const struct bvh_params *resolved, struct bvh *out);
whit_result spatial_build(const struct log *log, const struct bvh_box *boxes, uint32_t count,
                          const struct bvh_params *resolved, struct bvh *out);

/* A box with the primitive it belongs to. Records are moved, not indices to them, so that a subtree
   is one run of memory. */
struct build_record {
    alignas(32) float lo[3];
    uint32_t primitive;
    float hi[3];
    uint32_t pad;
};

/* Bounds of some records. Centroids are quartered sums lo / 4 + hi / 4: neither they nor their
   differences overflow. */
struct build_bounds {
    f4 lo, hi;
    f4 centroid_lo, centroid_hi;
};

/* Records [first, first + count) and where their subtree goes: node `node`, and pairs of children
   from pair slot `pair` on, of which it may use count - 1. */
struct build_range {
    struct build_bounds bounds;
    uint32_t node, pair, first, count, depth;
};

enum build_choice {
    BUILD_SPLIT, /* the records are in two runs, the bounds of both are known */
    BUILD_LEAF,  /* a leaf costs less; allowed by the leaf limit */
    BUILD_NONE,  /* no plane separates anything */
    BUILD_STOP,  /* the caller does not want the tree any more */
};

/* The depth from which nodes are split at the median: 28 more levels for 2^28 primitives. */
enum { BUILD_DEPTH_OF_MEDIANS = 96 };

/* ---- Top-down building (topdown.c) ---- */

/* The nodes while a tree grows. Pair slot s is nodes 2 + 2 s and 3 + 2 s. */
struct build_output {
    struct gpu_bvh_node *nodes;
    uint32_t *slots; /* 1: in use; later its place when squeezed */
};

/* What differs between builders. Ranges that do not overlap are given to several threads at once.
   `scratch` is 64-byte aligned and holds 64 * (range->count - 1) bytes. */
struct build_methods {
    void *context;
    /* With thread_count > 1 the work on this one range is to be spread over threads. */
    enum build_choice (*split)(void *context, const struct build_range *range,
                               uint32_t thread_count, void *scratch, uint32_t *left_count,
                               struct build_bounds halves[2]);
    /* The same without a choice, and without fail: for BUILD_NONE above the leaf limit. */
    void (*halve)(void *context, const struct build_range *range, void *scratch,
                  uint32_t *left_count, struct build_bounds halves[2]);
    /* Builds the whole subtree of a range of at most small_count records. */
    void (*small)(void *context, const struct build_output *output,
                  const struct build_range *range);
    uint32_t small_count;
};

/* Grows the tree over `count` items within `bounds`; fills all of *out but `order`, which it
   allocates. WHIT_ERROR_CANCELLED, without a message, after BUILD_STOP. */
whit_result topdown_grow(const struct log *log, const struct build_methods *methods,
                         const struct bvh_params *params, const struct build_bounds *bounds,
                         uint32_t count, struct bvh *out);

/* bvh_complete by several threads: the same bits for any number of them. */
void build_complete(struct bvh *bvh, double traversal_cost, uint32_t thread_count);

/* ---- Records (records.c) ---- */

/* In the order of the input, zeros without sign, and room for `spare` more behind them. free() */
whit_result records_make(const struct log *log, const struct bvh_box *boxes, uint32_t count,
                         uint32_t spare, uint32_t thread_count, struct build_record **records,
                         struct build_bounds *bounds);

/* Chooses the best of equally spaced planes on each axis by surface area, and partitions. */
enum build_choice split_binned(struct build_record *records, const struct build_range *range,
                               const struct bvh_params *params, uint32_t thread_count,
                               struct build_record *scratch, uint32_t *left_count,
                               struct build_bounds halves[2]);

/* Halves the records along the axis of the widest centroids; equal centroids by primitive. */
void split_median(struct build_record *records, const struct build_range *range,
                  uint32_t *left_count, struct build_bounds halves[2]);

/* ---- Small subtrees (sweep_small.c) ---- */

/* At most BUILD_SMALL boxes, and their order along each axis. */
enum { BUILD_SMALL = 16 };
struct small {
    f4 lo[BUILD_SMALL], hi[BUILD_SMALL];
    alignas(16) float centroid[BUILD_SMALL][4];
    uint8_t order[2][3]
                 [BUILD_SMALL];  /* nodes read one side and write the other for their children */
    uint8_t leaves[BUILD_SMALL]; /* the result: boxes leaf by leaf */
};

/* Fills order[0]: by centroid, equal ones by position. */
void small_sort(struct small *small, uint32_t count);
/* Grows the subtree over the boxes of `range` by sweeping over every position along order[0]. */
void small_grow(struct small *small, const struct build_output *output,
                const struct bvh_params *params, const struct build_range *range);

/* ---- */

static inline f4 build_record_lo(const struct build_record *r)
{
    return f4_xyz(f4_load(r->lo));
}
static inline f4 build_record_hi(const struct build_record *r)
{
    return f4_xyz(f4_load(r->hi));
}

static inline f4 build_centroid(f4 lo, f4 hi)
{
    f4 quarter = f4_splat(0.25f);
    return f4_add(f4_mul(lo, quarter), f4_mul(hi, quarter));
}

/* A power of two that brings the largest extent into [0.5, 1], or near it at the ends of the range
   of floats: areas neither overflow nor vanish, whatever the scene's unit. */
static inline f4 build_scale_of(f4 lo, f4 hi)
{
    alignas(16) float e[4];
    f4_store(e, f4_sub(hi, lo));
    float extent = e[0] > e[1] ? e[0] : e[1];
    extent = extent > e[2] ? extent : e[2];
    uint32_t bits;
    memcpy(&bits, &extent, sizeof bits);
    int exponent = (int)(bits >> 23) - 126;
    exponent = exponent > 126 ? 126 : exponent;
    bits = (uint32_t)(127 - exponent) << 23;
    float scale;
    memcpy(&scale, &bits, sizeof scale);
    return f4_splat(scale);
}

static inline f4 build_area_scale(const struct build_bounds *bounds)
{
    return build_scale_of(bounds->lo, bounds->hi);
}

static inline float build_scaled_area(f4 lo, f4 hi, f4 scale)
{
    return f4_half_area(f4_sub(f4_mul(hi, scale), f4_mul(lo, scale)));
}

static inline struct build_bounds build_bounds_empty(void)
{
    f4 big = f4_set(FLT_MAX, FLT_MAX, FLT_MAX, 0.0f);
    f4 small = f4_set(-FLT_MAX, -FLT_MAX, -FLT_MAX, 0.0f);
    return (struct build_bounds){big, small, big, small};
}

static inline void build_bounds_add(struct build_bounds *b, f4 lo, f4 hi)
{
    f4 centroid = build_centroid(lo, hi);
    b->lo = f4_min(b->lo, lo);
    b->hi = f4_max(b->hi, hi);
    b->centroid_lo = f4_min(b->centroid_lo, centroid);
    b->centroid_hi = f4_max(b->centroid_hi, centroid);
}

static inline void build_bounds_merge(struct build_bounds *a, const struct build_bounds *b)
{
    a->lo = f4_min(a->lo, b->lo);
    a->hi = f4_max(a->hi, b->hi);
    a->centroid_lo = f4_min(a->centroid_lo, b->centroid_lo);
    a->centroid_hi = f4_max(a->centroid_hi, b->centroid_hi);
}

static inline void build_node_write(struct gpu_bvh_node *node, f4 lo, f4 hi, uint32_t first,
                                    uint32_t count)
{
    alignas(16) float low[4], high[4];
    f4_store(low, lo);
    f4_store(high, hi);
    memcpy(node->lo, low, sizeof node->lo);
    memcpy(node->hi, high, sizeof node->hi);
    node->first = first;
    node->count = count;
}

#endif

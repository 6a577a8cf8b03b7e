/* Types and functions that the builders share, and that no file outside of bvh/ includes. */
#ifndef BVH_BUILD_H
#define BVH_BUILD_H

#include <float.h>
#include <math.h>
#include <stdalign.h>
#include <string.h>

#include "base/vec.h"
#include "bvh/bvh.h"
#include "bvh/f4.h"

/* Builders, called by bvh_build with at least one box. `resolved` has no 0 that stands for a
   default, except `bins` of WHIT_BUILD_BINNED, where 0 lets the number follow the size of the node.
   They fill in *out, but for what bvh_complete computes; on failure the caller frees what is in
   it. */
typedef whit_result build_fn(const whit_log *log, const struct bvh_box *boxes, uint32_t count,
                             const struct bvh_triangles *triangles,
                             const whit_accel_params *resolved, struct bvh *out);
build_fn records_build, sweep_build, spatial_build;

/* Bits of `flags` of a record. */
#define SPATIAL_WHOLE 1u /* must not be split */
#define SPATIAL_PART  2u /* was split: the box is that of a part */

/* A primitive reference: a box and the primitive that it belongs to. Builders move the records
   themselves, not indices to them, so that a subtree is one run of memory. */
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

/* A subtree to build: over the records [first, first + count), behind which there is room for
   `spare` more. Its root is node `node`; its pairs of children start at pair slot `pair`, of which
   it may use count + spare - 1. */
struct build_range {
    struct build_bounds bounds;
    uint32_t node, pair, first, count, spare, depth;
};

/* The two runs that the records of a range were split into, the second behind the first. A record
   that was split itself has a part in both: together they are at most count + spare. */
struct build_halves {
    struct build_bounds bounds[2];
    uint32_t count[2];
};

enum build_choice {
    BUILD_SPLIT, /* the records are in two runs */
    BUILD_LEAF,  /* a leaf costs less; allowed by the leaf limit */
    BUILD_NONE,  /* no plane separates the records */
};

/* From this depth on nodes are split at the median: 28 more levels for 2^28 primitives. */
enum { BUILD_DEPTH_OF_MEDIANS = 96 };

/* The nodes of a growing tree. Pair slot s is nodes 2 + 2 s and 3 + 2 s. */
struct build_output {
    struct gpu_bvh_node *nodes;
    uint32_t *slots; /* of each pair slot: the depth of its nodes, 0 if it is not in use; then its
                        number in the finished tree */
};

/* The functions that each builder has of its own. Several threads call them at once, for ranges
   that do not overlap. `scratch` is 64-byte aligned and holds 64 * (range->count - 1) bytes. */
struct builder {
    const whit_accel_params *params;
    struct build_record *records;
    void *context; /* the builder's own data */
    /* Chooses a split and makes it. thread_count is above 1 only where `threaded` is set: then the
       work on this one range is to be spread over threads. NULL: always `halve`. */
    enum build_choice (*split)(const struct builder *builder, const struct build_range *range,
                               uint32_t thread_count, void *scratch, struct build_halves *halves);
    bool threaded;
    /* Makes a split, whatever it costs: called where `split` gives BUILD_NONE and the range is
       above the leaf limit. */
    void (*halve)(const struct builder *builder, const struct build_range *range, void *scratch,
                  struct build_halves *halves);
    /* Builds the whole subtree of a range of at most small_count records. */
    void (*small)(const struct builder *builder, const struct build_output *output,
                  const struct build_range *range);
    uint32_t small_count;
};

/* A function for builder->halve: splits at the median centroid, on the axis where centroids are
   spread widest. Equal centroids are in the order of their primitives. */
void split_median(const struct builder *builder, const struct build_range *range, void *scratch,
                  struct build_halves *halves);

/* ---- Boxes ---- */

static inline struct build_box build_box_empty(void)
{
    return (struct build_box){{FLT_MAX, FLT_MAX, FLT_MAX, 0.0f},
                              {-FLT_MAX, -FLT_MAX, -FLT_MAX, 0.0f}};
}

static inline struct build_box build_box_unite(struct build_box a, struct build_box b)
{
    return (struct build_box){f4_min(a.lo, b.lo), f4_max(a.hi, b.hi)};
}

static inline struct build_box build_record_box(const struct build_record *r)
{
    return (struct build_box){f4_load(r->lo), f4_load(r->hi)};
}

static inline struct build_box build_node_box(const struct gpu_bvh_node *node)
{
    return (struct build_box){f4_load(node->lo), f4_load(node->hi)};
}

static inline void build_node_write(struct gpu_bvh_node *node, struct build_box box, uint32_t first,
                                    uint32_t count)
{
    memcpy(node->lo, &box.lo, sizeof node->lo);
    memcpy(node->hi, &box.hi, sizeof node->hi);
    node->first = first;
    node->count = count;
}

static inline f4 build_centroid(struct build_box box)
{
    return box.lo * 0.25f + box.hi * 0.25f;
}

/* build_centroid along one axis. */
static inline float build_centroid_along(const struct build_record *record, uint32_t axis)
{
    return record->lo[axis] * 0.25f + record->hi[axis] * 0.25f;
}

static inline struct build_bounds build_bounds_empty(void)
{
    return (struct build_bounds){build_box_empty(), build_box_empty()};
}

static inline void build_bounds_add(struct build_bounds *b, struct build_box box)
{
    f4 centroid = build_centroid(box);
    b->box = build_box_unite(b->box, box);
    b->centroids = build_box_unite(b->centroids, (struct build_box){centroid, centroid});
}

/* ---- Costs ---- */

/* A power of two that scales the largest extent into [0.5, 1], or near it at the ends of the range
   of floats, so that areas neither overflow nor vanish, whatever the scene's unit. */
static inline f4 build_scale(struct build_box box)
{
    f4 e = box.hi - box.lo;
    float extent = e[0] > e[1] ? e[0] : e[1];
    extent = extent > e[2] ? extent : e[2];
    int exponent = (int)(float_bits(extent) >> 23) - 126;
    exponent = exponent > 126 ? 126 : exponent;
    return f4_splat(float_of_bits((uint32_t)(127 - exponent) << 23));
}

static inline float build_area(struct build_box box, f4 scale)
{
    return f4_half_area(box.hi * scale - box.lo * scale);
}

/* The build_area of each of three boxes, in the first three lanes. */
static inline f4 build_areas(const struct build_box box[3], f4 scale)
{
    return f4_half_areas(box[0].hi * scale - box[0].lo * scale,
                         box[1].hi * scale - box[1].lo * scale,
                         box[2].hi * scale - box[2].lo * scale);
}

/* Whether a leaf is allowed, and costs no more than a pair of nodes and a split of this cost. To
   test a pair costs as much as to test a primitive. */
static inline bool build_leaf_pays(const whit_accel_params *params, uint32_t count, float area,
                                   float split_cost)
{
    return count <= params->leaf_limit && area * (float)count <= area + split_cost;
}

static inline uint32_t build_widest_axis(f4 extent)
{
    uint32_t axis = extent[1] > extent[0] ? 1 : 0;
    return extent[2] > extent[axis] ? 2 : axis;
}

/* Maps floats to unsigned integers of the same order. */
static inline uint32_t build_ordered_bits(float value)
{
    uint32_t bits = float_bits(value + 0.0f); /* turns -0 into +0 */
    return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

static inline void build_records_swap(struct build_record *a, struct build_record *b)
{
    struct build_record moved = *a;
    *a = *b;
    *b = moved;
}

#endif

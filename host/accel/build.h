/* Inside of the builders: what bvh.c hands to them, and topdown.c to split_*.c. */
#ifndef ACCEL_BUILD_H
#define ACCEL_BUILD_H

#include <float.h>
#include <math.h>
#include <stdalign.h>

#include "accel/accel.h"
#include "accel/f4.h"

/* Builders, called by bvh_build with at least one box and parameters in which no 0 stands for a
   default. They fill *out up to bvh_complete; on failure the caller releases what is in it. */
whit_result topdown_build(const struct log *log, const struct bvh_box *boxes, uint32_t count,
                          const struct bvh_params *resolved, struct bvh *out);
/* spatial.c */
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
};

/* Chooses the best of `bins` - 1 planes on each axis by surface area, and partitions. With
   thread_count > 1 the binning of this one range is spread over threads. */
enum build_choice split_binned(struct build_record *records, const struct build_range *range,
                               const struct bvh_params *params, uint32_t thread_count,
                               uint32_t *left_count, struct build_bounds halves[2]);

/* The same over every position instead of bins, for at most BUILD_FEW records. */
enum { BUILD_FEW = 8 };
enum build_choice split_few(struct build_record *records, const struct build_range *range,
                            const struct bvh_params *params, uint32_t *left_count,
                            struct build_bounds halves[2]);

/* Halves the records along the axis of the widest centroids; equal centroids by primitive. */
void split_median(struct build_record *records, const struct build_range *range,
                  uint32_t *left_count, struct build_bounds halves[2]);

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

/* A power of two that brings the node's largest extent into [0.5, 1): areas neither overflow nor
   vanish, whatever the scene's unit. */
static inline f4 build_area_scale(const struct build_bounds *bounds)
{
    alignas(16) float lo[4], hi[4];
    f4_store(lo, bounds->lo);
    f4_store(hi, bounds->hi);
    double extent = 0.0;
    for (int i = 0; i < 3; ++i) {
        double along = (double)hi[i] - (double)lo[i];
        extent = along > extent ? along : extent;
    }
    int exponent;
    (void)frexp(extent, &exponent);
    exponent = exponent < -126 ? -126 : exponent > 126 ? 126 : exponent;
    return f4_splat(ldexpf(1.0f, -exponent));
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

#endif

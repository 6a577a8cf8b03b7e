/* One tree over boxes, from any of the builders. */
#ifndef BVH_BVH_H
#define BVH_BVH_H

#include <float.h>
#include <stdbool.h>
#include <stdint.h>

#include "abi/bvh.h"
#include "base/log.h"
#include "whit/whit_accel.h"

struct bvh_box {
    float lo[3], hi[3];
};

/* The triangles that the boxes bound. */
struct bvh_triangles {
    const float *positions;  /* 3 per vertex */
    const uint32_t *indices; /* 3 per triangle */
    const uint8_t *whole;    /* 1: must stay in one leaf; NULL: none must */
};

/* nodes[0] is the root, nodes[1] is unused. `order` lists the primitives leaf by leaf. */
struct bvh {
    struct gpu_bvh_node *nodes; /* 64-byte aligned; free() */
    uint32_t *order;            /* free() */
    uint32_t node_count;        /* includes nodes[1]; 0: no primitives */
    uint32_t primitive_count;
    uint32_t
        reference_count; /* length of `order`; beyond primitive_count where triangles were split */
    uint32_t depth;      /* inner nodes on the longest path: the stack a traversal needs */
    bool clipped;        /* leaf boxes may hold parts of their triangles only */
    double sah_cost;     /* expected cost of a random ray, relative to the root's area */
};

/* WHIT_ERROR_USAGE, logged, for params of which no builder makes a tree; those of one builder are
   checked for all of them. */
WHIT_CHECK whit_result bvh_check(const whit_log *log, const whit_accel_params *params);

/* Boxes must be finite with lo <= hi. `triangles`: for WHIT_BUILD_SPATIAL, else NULL.
   WHIT_BUILD_NONE keeps the order of the input, in full leaves. `params` (NULL: the defaults) is
   for one tree: instances and validate are not read. Deterministic. */
WHIT_CHECK whit_result bvh_build(const whit_log *log, const struct bvh_box *boxes, uint32_t count,
                                 const struct bvh_triangles *triangles,
                                 const whit_accel_params *params, struct bvh *out);
void bvh_finish(struct bvh *bvh);

static inline uint32_t bvh_count(const struct gpu_bvh_node *node)
{
    return node->count & BVH_COUNT_MASK;
}

/* Half the surface area of the node's box. */
static inline double bvh_half_area(const struct gpu_bvh_node *node)
{
    double x = (double)node->hi[0] - (double)node->lo[0];
    double y = (double)node->hi[1] - (double)node->lo[1];
    double z = (double)node->hi[2] - (double)node->lo[2];
    return x * y + y * z + z * x;
}

/* Whether a box is finite and not inside out; false for NaN. */
static inline bool bvh_box_is_sane(const float lo[3], const float hi[3])
{
    bool sane = true;
    for (int i = 0; i < 3; ++i)
        sane &= lo[i] >= -FLT_MAX && lo[i] <= hi[i] && hi[i] <= FLT_MAX;
    return sane;
}

static inline struct bvh_box bvh_node_box(const struct gpu_bvh_node *node)
{
    return (struct bvh_box){{node->lo[0], node->lo[1], node->lo[2]},
                            {node->hi[0], node->hi[1], node->hi[2]}};
}

enum { BVH_DEPTH_MAX = 128 };

#endif

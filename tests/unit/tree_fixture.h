/* Trees written by hand, deeper than builders make them. */
#ifndef TESTS_TREE_FIXTURE_H
#define TESTS_TREE_FIXTURE_H

#include <stdlib.h>
#include <string.h>

#include "accel/accel.h"
#include "base/array.h"
#include "bvh/complete.h"

/* Triangle i of a caterpillar, which is a tree that is one long chain of nodes: it lies in the
   plane z = i, and any ray along the z axis hits it. */
static inline void caterpillar_corners(uint32_t i, float corners[9])
{
    const float z = (float)i;
    const float flat[9] = {-2, -1, z, 2, -1, z, 0, 2, z};
    memcpy(corners, flat, sizeof flat);
}

static inline void caterpillar_box(uint32_t first, uint32_t last, struct gpu_bvh_node *node)
{
    const float lo[3] = {-2, -1, (float)first}, hi[3] = {2, 2, (float)last};
    memcpy(node->lo, lo, sizeof lo);
    memcpy(node->hi, hi, sizeof hi);
}

/* A chain of 2 * depth + 2 nodes at `base`. Pair k holds the node of the rest of the chain, then
   leaf k, so that a ray from above keeps one node a level on its stack, in every order. */
static inline struct gpu_bvh_node *caterpillar_nodes(uint32_t depth, uint32_t base)
{
    struct gpu_bvh_node *nodes = array_alloc_aligned(base + 2 * depth + 2, sizeof *nodes);
    if (!nodes)
        return NULL;
    memset(nodes, 0, (base + 2 * depth + 2) * sizeof *nodes);
    struct gpu_bvh_node *root = &nodes[base];
    caterpillar_box(0, depth, root);
    root->first = base + 2;
    for (uint32_t k = 0; k < depth; ++k) {
        struct gpu_bvh_node *rest = &root[2 + 2 * k], *leaf = rest + 1;
        caterpillar_box(k + 1, depth, rest);
        caterpillar_box(k, k, leaf);
        rest->first = k + 1 < depth ? base + 2 * k + 4 : depth;
        rest->count = k + 1 < depth ? 0 : 1;
        leaf->first = k;
        leaf->count = 1;
        bvh_set_axis(rest);
    }
    return nodes;
}

static inline struct gpu_ray caterpillar_ray(uint32_t depth, bool from_above)
{
    struct gpu_ray ray = {.t_max = INFINITY};
    ray.origin[2] = from_above ? (float)depth + 1.0f : -1.0f;
    ray.dir[2] = from_above ? -1.0f : 1.0f;
    return ray;
}

#endif

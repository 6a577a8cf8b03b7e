/* Makes trees with up to eight children per node from finished binary trees: Wald, Benthin and
   Boulos 2008, "Getting rid of packets", 3.2: of a node's children, the one with the largest area
   is replaced by its own two children until there are eight. Leaves stay as they are. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "accel/bvh8.h"
#include "base/array.h"

/* An eight-wide node still to be made: its number `at`, its `depth` (root: 1), and the two children
   at `pair` and `pair` + 1 of the binary tree that it starts from. */
struct opening {
    uint32_t pair, at, depth;
};

/* Index of the inner child with the largest area; -1: all children are leaves. */
static int largest_inner(const struct gpu_bvh_node *children, int count)
{
    int largest = -1;
    double area = -1.0;
    for (int i = 0; i < count; ++i) {
        if (bvh_count(&children[i]) == 0 && bvh_half_area(&children[i]) > area) {
            largest = i;
            area = bvh_half_area(&children[i]);
        }
    }
    return largest;
}

static int open_children(const struct gpu_bvh_node *nodes, uint32_t pair,
                         struct gpu_bvh_node children[8])
{
    int count = 2, inner;
    memcpy(children, &nodes[pair], 2 * sizeof *children);
    while (count < 8 && (inner = largest_inner(children, count)) >= 0) {
        const struct gpu_bvh_node *opened = &nodes[children[inner].first];
        children[inner] = opened[0];
        children[count++] = opened[1];
    }
    return count;
}

/* An empty child: its box is a point that no ray hits, and its ref would end the traversal of a ray
   that did. */
static const struct gpu_bvh_node none = {.lo = {3e38f, 3e38f, 3e38f},
                                         .first = BVH_FIRST_MASK,
                                         .hi = {3e38f, 3e38f, 3e38f},
                                         .count = BVH_COUNT_MASK};

static bool reserve_node(struct accel_bvh8 *out, uint32_t *at)
{
    *at = out->node_count;
    if (out->node_count == out->capacity) {
        uint32_t capacity = out->capacity ? out->capacity + out->capacity / 2 : 64;
        struct gpu_bvh_node *grown = realloc(out->nodes, (size_t)capacity * 8 * sizeof *grown);
        if (!grown)
            return false;
        out->nodes = grown;
        out->capacity = capacity;
    }
    for (int i = 0; i < 8; ++i)
        out->nodes[(size_t)*at * 8 + (size_t)i] = none;
    ++out->node_count;
    return true;
}

/* Appends an eight-wide copy of the binary tree at `ref`; *root is the copy's ref. False: out of
   memory. */
static bool widen(const struct gpu_bvh_node *nodes, uint32_t ref, struct accel_bvh8 *out,
                  uint32_t *root, uint32_t *depth)
{
    struct opening stack[8 * BVH_DEPTH_MAX];
    uint32_t height = 0;
    *root = ref;
    *depth = 0;
    if (ref >> BVH_COUNT_SHIFT != 0)
        return true;
    if (!reserve_node(out, root))
        return false;
    stack[height++] = (struct opening){.pair = ref, .at = *root, .depth = 1};
    while (height > 0) {
        struct opening opening = stack[--height];
        struct gpu_bvh_node children[8];
        int count = open_children(nodes, opening.pair, children);
        *depth = opening.depth > *depth ? opening.depth : *depth;
        for (int i = 0; i < count; ++i) {
            uint32_t own = bvh_count(&children[i]);
            if (own == 0) {
                uint32_t at;
                if (!reserve_node(out, &at))
                    return false;
                stack[height++] = (struct opening){
                    .pair = children[i].first, .at = at, .depth = opening.depth + 1};
                children[i].first = at;
            }
            children[i].count = own; /* without the axis bits of a pair */
            out->nodes[(size_t)opening.at * 8 + (size_t)i] = children[i];
        }
    }
    return true;
}

static bool widen_meshes(struct accel *accel, struct accel_bvh8 *out)
{
    free(out->mesh_roots);
    out->mesh_roots = array_alloc(accel->mesh_count, sizeof *out->mesh_roots);
    out->mesh_depth = 0;
    if (!out->mesh_roots)
        return false;
    for (uint32_t i = 0; i < accel->mesh_count; ++i) {
        uint32_t depth;
        if (!widen(accel->nodes, accel->meshes[i].root, out, &out->mesh_roots[i], &depth))
            return false;
        out->mesh_depth = depth > out->mesh_depth ? depth : out->mesh_depth;
    }
    out->mesh_node_count = out->node_count;
    return true;
}

whit_result accel_widen(struct accel *accel)
{
    struct accel_bvh8 *out = &accel->bvh8;
    bool good = true;
    if (!out->mesh_roots || accel->flat) {
        out->node_count = 0;
        good = widen_meshes(accel, out);
    }
    out->node_count = out->mesh_node_count;
    good = good && widen(accel->nodes, accel->instance_root, out, &out->instance_root,
                         &out->instance_depth);
    if (!good) {
        accel_bvh8_finish(out); /* trees made in part are not kept */
        return log_failure(&accel->log, WHIT_ERROR_MEMORY, "%s: out of memory for its trees",
                           accel->scene->name);
    }
    for (uint32_t i = 0; i < accel->instance_count; ++i)
        accel->instances[i].root8 = out->mesh_roots[accel->flat ? 0 : accel->instances[i].mesh];
    return WHIT_OK;
}

void accel_bvh8_finish(struct accel_bvh8 *bvh8)
{
    free(bvh8->nodes);
    free(bvh8->mesh_roots);
    *bvh8 = (struct accel_bvh8){0};
}

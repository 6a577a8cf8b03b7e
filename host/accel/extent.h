/* Boxes of primitives, and boxes of transformed boxes. */
#ifndef ACCEL_EXTENT_H
#define ACCEL_EXTENT_H

#include <math.h>

#include "accel/accel.h"

/* Exact: minima and maxima of floats, nothing rounded. */
static inline struct bvh_box accel_triangle_box(const float a[3], const float b[3],
                                                const float c[3])
{
    struct bvh_box box;
    for (int i = 0; i < 3; ++i) {
        float lo = a[i] < b[i] ? a[i] : b[i], hi = a[i] > b[i] ? a[i] : b[i];
        box.lo[i] = c[i] < lo ? c[i] : lo;
        box.hi[i] = c[i] > hi ? c[i] : hi;
    }
    return box;
}

/* The same bits as sphere_box of shaders/lib/sphere.glsl. The sphere test looks for hits within
   this box, so boxes of nodes must hold all of it. */
static inline struct bvh_box accel_sphere_box(const float center[3], float radius)
{
    struct bvh_box box;
    for (int i = 0; i < 3; ++i) {
        float margin = (fabsf(center[i]) + radius) * (1.0f / 4194304.0f);
        box.lo[i] = (center[i] - radius) - margin;
        box.hi[i] = (center[i] + radius) + margin;
    }
    return box;
}

static inline struct bvh_box accel_record_box(const struct gpu_triangle *record)
{
    if (record->flags & TRIANGLE_SPHERE)
        return accel_sphere_box(record->v0, record->v1[0]);
    return accel_triangle_box(record->v0, record->v1, record->v2);
}

static inline struct bvh_box accel_primitive_box(const struct scene_mesh *mesh, uint32_t primitive)
{
    if (mesh->sphere_count) {
        const float *sphere = &mesh->spheres[4 * (size_t)primitive];
        return accel_sphere_box(sphere, sphere[3]);
    }
    const uint32_t *corner = &mesh->indices[3 * (size_t)primitive];
    return accel_triangle_box(&mesh->positions[3 * (size_t)corner[0]],
                              &mesh->positions[3 * (size_t)corner[1]],
                              &mesh->positions[3 * (size_t)corner[2]]);
}

static inline uint32_t accel_node_ref(const struct gpu_bvh_node *node)
{
    return bvh_count(node) << BVH_COUNT_SHIFT | node->first;
}

/* The accel_mesh of a mesh with a tree of its own. Its first node and first record are 0 here: they
   are set when the arrays of all meshes are put together. */
static inline struct accel_mesh accel_mesh_over(const struct bvh *tree)
{
    return (struct accel_mesh){
        .root = tree->node_count > 0 ? accel_node_ref(&tree->nodes[0]) : BVH_EMPTY_REF,
        .node_count = tree->node_count,
        .record_count = tree->reference_count,
        .triangle_count = tree->primitive_count,
        .depth = tree->depth,
        .sah_cost = tree->sah_cost,
        .box = tree->node_count > 0 ? bvh_node_box(&tree->nodes[0]) : (struct bvh_box){{0}, {0}},
    };
}

/* A box under an affine map, row-major 3x4 in double. `size` bounds the magnitudes of the terms
   that are summed: rounding errors are relative to it. */
struct accel_extent {
    double lo[3], hi[3], size[3];
};

static inline struct accel_extent accel_transformed_box(const double rows[12],
                                                        const struct bvh_box *box)
{
    struct accel_extent out;
    for (int r = 0; r < 3; ++r) {
        double t = rows[4 * r + 3];
        out.lo[r] = out.hi[r] = t;
        out.size[r] = fabs(t);
        for (int c = 0; c < 3; ++c) {
            double a = rows[4 * r + c] * (double)box->lo[c];
            double b = rows[4 * r + c] * (double)box->hi[c];
            out.lo[r] += a < b ? a : b;
            out.hi[r] += a < b ? b : a;
            out.size[r] += fabs(a) > fabs(b) ? fabs(a) : fabs(b);
        }
    }
    return out;
}

#endif

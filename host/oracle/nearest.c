/* How far a point is from a scene's surfaces, in double. */
#include <float.h>
#include <math.h>

#include "abi/shade.h"
#include "accel/extent.h"
#include "base/vec.h"
#include "oracle/nearest.h"

struct query {
    const struct accel *accel;
    const struct scene_pose *pose; /* NULL: leaves hold records, else instances */
    struct affine placed;          /* object to world, of the current instance */
    double p[3], best2;
};

/* Squared distance to the world-space box of a node's box: at most that to its contents. */
static double node_distance2(const struct query *q, const struct gpu_bvh_node *node)
{
    const struct bvh_box box = bvh_node_box(node);
    struct accel_extent world = accel_transformed_box(q->placed.m, &box);
    double sum = 0.0;
    for (int r = 0; r < 3; ++r) {
        double away = fmax(fmax(world.lo[r] - q->p[r], q->p[r] - world.hi[r]), 0.0);
        sum += away * away;
    }
    return sum;
}

/* Nearest point of a triangle: Ericson 2005, "Real-Time Collision Detection", 5.1.5. */
static double triangle_distance2(const double p[3], double v[3][3])
{
    double ab[3], ac[3], ap[3], bp[3], cp[3];
    for (int k = 0; k < 3; ++k) {
        ab[k] = v[1][k] - v[0][k];
        ac[k] = v[2][k] - v[0][k];
        ap[k] = p[k] - v[0][k];
        bp[k] = p[k] - v[1][k];
        cp[k] = p[k] - v[2][k];
    }
    double d1 = double3_dot(ab, ap), d2 = double3_dot(ac, ap), d3 = double3_dot(ab, bp),
           d4 = double3_dot(ac, bp);
    double d5 = double3_dot(ab, cp), d6 = double3_dot(ac, cp);
    double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
    double s = 0.0, t = 0.0; /* weights along ab and ac */
    if (d1 <= 0 && d2 <= 0)
        s = t = 0;
    else if (d3 >= 0 && d4 <= d3)
        s = 1;
    else if (d6 >= 0 && d5 <= d6)
        t = 1;
    else if (vc <= 0 && d1 >= 0 && d3 <= 0)
        s = d1 / (d1 - d3);
    else if (vb <= 0 && d2 >= 0 && d6 <= 0)
        t = d2 / (d2 - d6);
    else if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        s = 1 - t;
    } else if (va + vb + vc > 0) {
        s = vb / (va + vb + vc);
        t = vc / (va + vb + vc);
    }
    double sum = 0.0;
    for (int k = 0; k < 3; ++k) {
        double away = ap[k] - s * ab[k] - t * ac[k];
        sum += away * away;
    }
    return sum;
}

/* Squared distance to a sphere; a lower bound where the instance's transform stretches it. */
static double sphere_distance2(const struct query *q, const struct gpu_triangle *record)
{
    double center[3], at[3], stretch2 = 0.0, away2 = 0.0;
    for (int k = 0; k < 3; ++k)
        center[k] = (double)record->v0[k];
    affine_point(&q->placed, center, at);
    for (int r = 0; r < 3; ++r) {
        for (int k = 0; k < 3; ++k)
            stretch2 += q->placed.m[4 * r + k] * q->placed.m[4 * r + k];
        away2 += (q->p[r] - at[r]) * (q->p[r] - at[r]);
    }
    double gap = sqrt(away2) - (double)record->v1[0] * sqrt(stretch2);
    return gap > 0.0 ? gap * gap : 0.0;
}

static void visit_record(struct query *q, uint32_t index)
{
    const struct gpu_triangle *record = &q->accel->triangles[index];
    if (record->flags & TRIANGLE_SPHERE) {
        q->best2 = fmin(q->best2, sphere_distance2(q, record));
        return;
    }
    const float *corners[3] = {record->v0, record->v1, record->v2};
    double v[3][3];
    for (int i = 0; i < 3; ++i) {
        double at[3] = {(double)corners[i][0], (double)corners[i][1], (double)corners[i][2]};
        affine_point(&q->placed, at, v[i]);
    }
    q->best2 = fmin(q->best2, triangle_distance2(q->p, v));
}

static void visit(struct query *q, uint32_t ref)
{
    uint32_t first = ref & BVH_FIRST_MASK, count = ref >> BVH_COUNT_SHIFT;
    if (ref == BVH_EMPTY_REF)
        return;
    if (count > 0 && q->pose) {
        struct query inside = *q;
        inside.pose = NULL;
        inside.placed = q->pose->instances[first];
        visit(&inside, q->accel->instances[first].root);
        q->best2 = inside.best2;
        return;
    }
    for (uint32_t i = 0; i < count; ++i)
        visit_record(q, first + i);
    if (count > 0)
        return;
    const struct gpu_bvh_node *pair = &q->accel->nodes[first];
    double away2[2] = {node_distance2(q, &pair[0]), node_distance2(q, &pair[1])};
    bool second = away2[1] < away2[0];
    for (int i = 0; i < 2; ++i) {
        bool at = i ? !second : second;
        if (away2[at] < q->best2)
            visit(q, accel_node_ref(&pair[at]));
    }
}

/* The square of the distance to the nearest surface, or `most2` if that is not less. */
static double distance2(const struct accel *accel, const struct scene_pose *pose, const double p[3],
                        double most2)
{
    struct query q = {.accel = accel,
                      .pose = accel->flat ? NULL : pose,
                      .placed = affine_identity(),
                      .p = {p[0], p[1], p[2]},
                      .best2 = most2};
    visit(&q, accel->flat ? accel->meshes[0].root : accel->instance_root);
    return q.best2;
}

double accel_distance(const struct accel *accel, const struct scene_pose *pose, const double p[3])
{
    double away2 = distance2(accel, pose, p, DBL_MAX);
    return away2 < DBL_MAX ? sqrt(away2) : INFINITY;
}

/* Roundings of the coordinates of a light, and of a surface in which it lies. */
static double rounding_of(const struct scene_pose *pose, const double position[3], double share)
{
    double largest = 0.0;
    for (int i = 0; i < 3; ++i) {
        largest = fmax(largest, fabs(position[i]));
        if (pose->lo[i] <= pose->hi[i])
            largest = fmax(largest, fmax(fabs(pose->lo[i]), fabs(pose->hi[i])));
    }
    return largest * share;
}

float accel_light_end(const struct accel *accel, const struct scene_pose *pose,
                      const struct scene_light *light)
{
    if (light->kind == WHIT_LIGHT_DIRECTIONAL)
        return 0.0f;
    if (light->kind != WHIT_LIGHT_POINT && light->kind != WHIT_LIGHT_SPOT)
        return (float)rounding_of(pose, light->position, 0x1p-20);
    double rounding = rounding_of(pose, light->position, 0x1p-23);
    double most2 = nextafter(rounding * rounding, INFINITY);
    return distance2(accel, pose, light->position, most2) < most2 ? (float)LIGHT_END_SHARE_MAX
                                                                  : 0.0f;
}

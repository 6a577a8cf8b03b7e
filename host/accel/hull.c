#include "accel/hull.h"

#include <math.h>
#include <string.h>

#include "abi/bvh.h"

/* The most pairs of a triangle and a vertex that are compared: half a millisecond. */
enum { PAIRS_MAX = 1 << 18 };

/* Bounds the roundings of the distance below, for the sum of its terms' magnitudes. */
static const double ROUNDING = 0x1p-48;

static bool is_planar(const struct scene_mesh *mesh)
{
    return mesh->lo[0] == mesh->hi[0] || mesh->lo[1] == mesh->hi[1] || mesh->lo[2] == mesh->hi[2];
}

/* The plane of a triangle. */
struct plane {
    double corners[3][3];
    double normal[3], size[3]; /* size: the sums of the magnitudes of the normal's terms */
};

static void plane_fill(struct plane *plane)
{
    double a[3], b[3];
    for (int i = 0; i < 3; ++i) {
        a[i] = plane->corners[1][i] - plane->corners[0][i];
        b[i] = plane->corners[2][i] - plane->corners[0][i];
    }
    for (int i = 0; i < 3; ++i) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        plane->normal[i] = a[j] * b[k] - a[k] * b[j];
        plane->size[i] = fabs(a[j] * b[k]) + fabs(a[k] * b[j]);
    }
}

/* Whether the vertex is certainly not in front of the triangle. */
static bool is_behind(const struct plane *plane, const double vertex[3])
{
    double distance = 0.0, size = 0.0;
    for (int i = 0; i < 3; ++i) {
        double way = vertex[i] - plane->corners[0][i];
        distance += plane->normal[i] * way;
        size += plane->size[i] * fabs(way);
    }
    if (distance <= -ROUNDING * size)
        return true;
    for (int c = 0; c < 3; ++c)
        if (memcmp(vertex, plane->corners[c], sizeof plane->corners[c]) == 0)
            return true;
    return false;
}

uint32_t accel_hull(const struct scene_mesh *mesh)
{
    if (mesh->sphere_count)
        return mesh->sphere_count == 1 ? HULL_CONVEX : HULL_NONE;
    if (is_planar(mesh))
        return HULL_PLANAR;
    if ((uint64_t)mesh->triangle_count * mesh->vertex_count > PAIRS_MAX)
        return HULL_NONE;
    for (uint32_t i = 0; i < mesh->triangle_count; ++i) {
        struct plane plane;
        scene_mesh_corners(mesh, i, plane.corners);
        plane_fill(&plane);
        for (uint32_t k = 0; k < mesh->vertex_count; ++k) {
            const float *position = &mesh->positions[3 * (size_t)k];
            const double vertex[3] = {(double)position[0], (double)position[1],
                                      (double)position[2]};
            if (!is_behind(&plane, vertex))
                return HULL_NONE;
        }
    }
    return HULL_CONVEX;
}

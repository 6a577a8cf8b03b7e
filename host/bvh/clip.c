/* Sutherland and Hodgman 1974, "Reentrant polygon clipping", one plane of the box after the other.
 */
#include "bvh/clip.h"

#include <math.h>
#include <string.h>

#include "base/vec.h"

static void polygon_cross(const double a[3], const double b[3], int axis, double plane,
                          struct clip_polygon *out)
{
    double *p = out->at[out->count++];
    double s = (plane - a[axis]) / (b[axis] - a[axis]);
    for (int k = 0; k < 3; ++k)
        p[k] = a[k] + s * (b[k] - a[k]);
    p[axis] = plane;
}

/* Keeps what lies in the plane or on one side of it. */
static void polygon_clip(const struct clip_polygon *in, int axis, double plane, bool above,
                         struct clip_polygon *out)
{
    out->count = 0;
    for (uint32_t i = 0; i < in->count; ++i) {
        const double *a = in->at[i], *b = in->at[i + 1 < in->count ? i + 1 : 0];
        bool a_in = above ? a[axis] >= plane : a[axis] <= plane;
        bool b_in = above ? b[axis] >= plane : b[axis] <= plane;
        if (a_in) {
            memcpy(out->at[out->count], a, sizeof out->at[0]);
            ++out->count;
        }
        if (a_in != b_in)
            polygon_cross(a, b, axis, plane, out);
        if (out->count + 2 > CLIP_CORNERS_MAX)
            return;
    }
}

static void polygon_range(const struct clip_polygon *polygon, int axis, double *lo, double *hi)
{
    *lo = *hi = polygon->at[0][axis];
    for (uint32_t i = 1; i < polygon->count; ++i) {
        *lo = fmin(*lo, polygon->at[i][axis]);
        *hi = fmax(*hi, polygon->at[i][axis]);
    }
}

const struct clip_polygon *clip_triangle(const struct clip_triangle *triangle,
                                         const struct bvh_box *cell, struct clip_polygon room[2])
{
    struct clip_polygon *polygon = &room[0], *other = &room[1];
    polygon->count = 3;
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k)
            polygon->at[i][k] = (double)triangle->v[i][k];
    }
    for (int side = 0; side < 6; ++side) {
        int axis = side / 2;
        bool above = side % 2 == 0;
        double lo, hi, plane = (double)(above ? cell->lo[axis] : cell->hi[axis]);
        polygon_range(polygon, axis, &lo, &hi);
        if (above ? lo >= plane : hi <= plane)
            continue;
        polygon_clip(polygon, axis, plane, above, other);
        struct clip_polygon *clipped = other;
        other = polygon;
        polygon = clipped;
        if (polygon->count == 0)
            return NULL;
    }
    return polygon;
}

bool clip_triangle_box(const struct clip_triangle *triangle, const struct bvh_box *cell,
                       struct bvh_box *out)
{
    struct clip_polygon room[2];
    const struct clip_polygon *polygon = clip_triangle(triangle, cell, room);
    if (!polygon)
        return false;
    for (int axis = 0; axis < 3; ++axis) {
        double lo, hi;
        polygon_range(polygon, axis, &lo, &hi);
        out->lo[axis] = fmaxf(float_below(lo), cell->lo[axis]) + 0.0f;
        out->hi[axis] = fminf(float_above(hi), cell->hi[axis]) + 0.0f;
        if (!(out->lo[axis] <= out->hi[axis]))
            return false;
    }
    return true;
}

struct bvh_box clip_widen(const struct bvh_box *part, const struct bvh_box *own)
{
    double extent = 0.0;
    for (int k = 0; k < 3; ++k)
        extent = fmax(extent, (double)own->hi[k] - (double)own->lo[k]);
    double margin = extent * CLIP_PART_MARGIN;
    struct bvh_box box;
    for (int k = 0; k < 3; ++k) {
        box.lo[k] = fmaxf(float_below((double)part->lo[k] - margin), own->lo[k]) + 0.0f;
        box.hi[k] = fminf(float_above((double)part->hi[k] + margin), own->hi[k]) + 0.0f;
    }
    return box;
}

/* Clips a triangle to a box, and bounds what is left. */
#ifndef BVH_CLIP_H
#define BVH_CLIP_H

#include <stdbool.h>

#include "bvh/bvh.h"

/* Three vertices. */
struct clip_triangle {
    const float *v[3];
};

static inline struct clip_triangle clip_fetch(const struct bvh_triangles *triangles,
                                              uint32_t primitive)
{
    const uint32_t *corner = &triangles->indices[3 * (size_t)primitive];
    return (struct clip_triangle){{&triangles->positions[3 * (size_t)corner[0]],
                                   &triangles->positions[3 * (size_t)corner[1]],
                                   &triangles->positions[3 * (size_t)corner[2]]}};
}

/* Six planes add a corner each to the triangle's three; more where rounding bends the polygon. */
enum { CLIP_CORNERS_MAX = 16 };
struct clip_polygon {
    double at[CLIP_CORNERS_MAX][3];
    uint32_t count;
};

/* Clips the triangle to the closed box. The result is room[0] or room[1]; NULL: nothing is left. It
   is computed in double: points on edges are off by less than a float can tell. */
const struct clip_polygon *clip_triangle(const struct clip_triangle *triangle,
                                         const struct bvh_box *cell, struct clip_polygon room[2]);

/* The bounds of the triangle's part within `cell`, rounded outwards to floats, but not beyond the
   cell. They hold the part up to the rounding of doubles, some 2^-50 of the coordinates. False when
   nothing is left, or nothing above that rounding. */
bool clip_triangle_box(const struct clip_triangle *triangle, const struct bvh_box *cell,
                       struct bvh_box *out);

/* For leaf boxes: the part's box with a margin around it, within the triangle's `own` box. The
   margin is more than what clipping rounds (an extent that is not 0 is at least 2^-24 of its
   coordinates), and leaves room for the rounding of the triangle test: docs/numerics-method.md,
   "Clipped triangles". */
#define CLIP_PART_MARGIN (1.0 / 4096.0) /* of the triangle's largest extent */
struct bvh_box clip_widen(const struct bvh_box *part, const struct bvh_box *own);

#endif

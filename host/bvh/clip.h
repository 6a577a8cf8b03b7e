/* The box of what a box leaves of a triangle. */
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

/* Each of six planes adds a corner to the three, or more if rounding bends it. */
enum { CLIP_CORNERS_MAX = 16 };
struct clip_polygon {
    double at[CLIP_CORNERS_MAX][3];
    uint32_t count;
};

/* What the closed box leaves of the triangle, which is one of the two; NULL: nothing. In double:
   points of edges are off by less than a float can tell. */
const struct clip_polygon *clip_triangle(const struct clip_triangle *triangle,
                                         const struct bvh_box *cell, struct clip_polygon room[2]);

/* The bounds of the part of the triangle in `cell`, rounded outwards to floats, within the cell.
   They hold that part but for what doubles round: some 2^-50 of the coordinates. False when nothing
   is left, or no more than that. */
bool clip_triangle_box(const struct clip_triangle *triangle, const struct bvh_box *cell,
                       struct bvh_box *out);

/* For leaves: the part's box with a margin around it, within the triangle's `own` box. The margin
   is more than what clipping rounds (an extent that is not 0 is at least 2^-24 of its coordinates),
   and leaves room for what the triangle test rounds: docs/numerics.md, "Clipped triangles". */
#define CLIP_PART_MARGIN (1.0 / 4096.0) /* of the triangle's largest extent */
struct bvh_box clip_widen(const struct bvh_box *part, const struct bvh_box *own);

#endif

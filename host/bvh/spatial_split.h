/* Spatial splits. */
#ifndef BVH_SPATIAL_SPLIT_H
#define BVH_SPATIAL_SPLIT_H

#include "bvh/build.h"

enum { SPATIAL_BINS = 16 };

/* Bin of a coordinate: (x / 2 - origin) * bins_per_half, so that no extent overflows. */
struct spatial_grid {
    f4 origin, bins_per_half;
    float start[3], width[3]; /* of bins; 0: the axis has one */
    int bins;
};

/* A plane, and what is expected of it. */
struct spatial_plane {
    struct spatial_grid grid;
    uint32_t axis, bin; /* references that start in bins below `bin` go left */
    float at;           /* coordinate */
    float cost;         /* relative to one primitive of the node's scaled area */
    uint32_t count[2];  /* of both sides, and their boxes */
    struct build_box side[2];
    f4 scale;
};

/* The best plane among bins that lets at most range->spare references be in both halves; false:
   none. Bins hold what they cut out of the triangles (Stich, Friedrich and Dietrich 2009, "Spatial
   splits in bounding volume hierarchies", 4.2: chopped binning). */
bool spatial_find(const struct build_record *records, const struct build_range *range,
                  const struct bvh_triangles *triangles, f4 scale, struct spatial_plane *plane);

/* Splits the records at the plane. A reference that would cost less whole stays whole (4.4:
   reference unsplitting). False: a half would be empty; then no record has changed, but for its
   place. */
bool spatial_apply(struct build_record *records, const struct build_range *range,
                   const struct spatial_plane *plane, const struct bvh_triangles *triangles,
                   struct build_halves *halves);

#endif

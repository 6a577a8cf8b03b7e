/* Spatial splits. */
#ifndef BVH_SPATIAL_SPLIT_H
#define BVH_SPATIAL_SPLIT_H

#include "bvh/build.h"

enum { SPATIAL_BINS = 16 };

/* The bin of a coordinate x is (x / 2 - origin) * bins_per_half; halved, so that no extent
   overflows. */
struct spatial_grid {
    f4 origin, bins_per_half;
    float start[3], width[3]; /* of bins; width 0: the axis has only one bin */
    int bins;
};

/* A plane, with its expected cost and the counts and boxes of both sides. */
struct spatial_plane {
    struct spatial_grid grid;
    uint32_t axis, bin; /* references that start in bins below `bin` go left */
    float at;           /* coordinate */
    float cost;         /* scaled half area times references, summed over both sides */
    uint32_t count[2];  /* of both sides */
    struct build_box side[2];
    f4 scale;
};

/* The best plane between bins for which both halves have at most range->spare references more than
   the range; false: there is none. Each bin bounds what it cuts out of the triangles (chopped
   binning: Stich, Friedrich and Dietrich 2009, "Spatial splits in bounding volume hierarchies",
   4.2). */
bool spatial_find(const struct build_record *records, const struct build_range *range,
                  const struct bvh_triangles *triangles, f4 scale, struct spatial_plane *plane);

/* Splits the records at the plane. A reference that costs less unsplit stays whole (reference
   unsplitting, 4.4). False: a half would be empty; then records have at most changed places. */
bool spatial_apply(struct build_record *records, const struct build_range *range,
                   const struct spatial_plane *plane, const struct bvh_triangles *triangles,
                   struct build_halves *halves);

#endif

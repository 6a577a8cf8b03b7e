/* Inside of the builder with spatial splits: what spatial.c asks of the splits. */
#ifndef BVH_SPATIAL_H
#define BVH_SPATIAL_H

#include "bvh/build.h"

/* In `pad` of a record. */
#define SPATIAL_WHOLE 1u /* must not be split */
#define SPATIAL_PART  2u /* was split: the box is that of a part */

/* ---- Object splits (spatial_object.c) ---- */

struct object_plane {
    uint32_t axis, left_count;
    float cost;                /* relative to one primitive of the node's scaled area */
    float bin;                 /* references whose centroid is in a bin below go left */
    f4 overlap_lo, overlap_hi; /* of the two halves; inside out where there is none */
    f4 origin, bins_per_unit;
};

/* The best plane; false: none separates anything. */
bool object_find(const struct build_record *records, const struct build_bounds *bounds,
                 uint32_t count, f4 scale, struct object_plane *plane);
/* Moves left_count references to the front. */
void object_apply(struct build_record *records, uint32_t count, const struct object_plane *plane,
                  struct build_bounds halves[2]);

/* ---- Spatial splits (spatial_split.c) ---- */

enum { SPATIAL_BINS = 16 };

/* A plane, and what is expected of it. */
struct spatial_plane {
    uint32_t axis, bin; /* references that start in bins below `bin` go left */
    float at;           /* coordinate */
    float cost;         /* relative to one primitive of the node's scaled area */
    uint32_t left_count, right_count;
    f4 left_lo, left_hi, right_lo, right_hi;
    /* Bin of a coordinate. */
    f4 origin, bins_per_half, last_bin, scale;
};

/* The best plane among bins that lets at most `spare` references be in both halves; false: none.
   Bins hold what they cut out of the triangles (Stich, Friedrich and Dietrich 2009, "Spatial splits
   in bounding volume hierarchies", 4.2: chopped binning). */
bool spatial_find(const struct build_record *records, const struct build_bounds *bounds,
                  uint32_t count, uint32_t spare, const struct bvh_triangles *triangles, f4 scale,
                  struct spatial_plane *plane);

/* Splits `count` records at the plane: [0, *left_count) are the left half and the next *right_count
   the right one, together at most count + `spare`. A reference that would cost less whole stays
   whole (4.4: reference unsplitting). False: a half would be empty; then no record has changed,
   but for its place. */
bool spatial_apply(struct build_record *records, uint32_t count, uint32_t spare,
                   const struct spatial_plane *plane, const struct bvh_triangles *triangles,
                   uint32_t *left_count, uint32_t *right_count, struct build_bounds halves[2]);

#endif

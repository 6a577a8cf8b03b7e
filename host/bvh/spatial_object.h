/* Object splits, for references to triangles or parts of triangles. */
#ifndef BVH_SPATIAL_OBJECT_H
#define BVH_SPATIAL_OBJECT_H

#include "bvh/split_binned.h"
#include "bvh/sweep_small.h"

/* The plane of an object split: `small` and `cut` hold it for up to BUILD_SMALL references, `bins`
   for more. */
struct object_plane {
    float cost; /* scaled half area times references, summed over both sides */
    struct build_box side[2];
    struct bin_plane bins;
    struct small small;
    struct small_cut cut;
    uint8_t index[BUILD_SMALL]; /* [i]: index in the node of box i of `small` */
};

/* The best plane, of infinite cost where none separates anything. */
void object_find(const struct build_record *records, const struct build_range *range, f4 scale,
                 struct object_plane *plane);
/* Moves the references on the plane's left to the front. */
void object_apply(struct build_record *records, uint32_t count, const struct object_plane *plane,
                  struct build_halves *halves);

#endif

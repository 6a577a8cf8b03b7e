/* Subtrees over few boxes. */
#ifndef BVH_SWEEP_SMALL_H
#define BVH_SWEEP_SMALL_H

#include "bvh/build.h"

/* At most BUILD_SMALL boxes, and their order along each axis. */
enum { BUILD_SMALL = 16 };
struct small {
    struct build_box box[BUILD_SMALL];
    f4 centroid[BUILD_SMALL];
    uint8_t order[2][3]
                 [BUILD_SMALL];  /* nodes read one side; they write the other for their children */
    uint8_t leaves[BUILD_SMALL]; /* the result: boxes leaf by leaf */
};

struct small_cut {
    uint32_t axis, left_count; /* positions of order[0][axis] left of the cut */
    float cost;
};

void small_put(struct small *small, uint32_t index, const struct build_record *record);
/* Fills order[0]: by centroid, equal ones by position. */
void small_sort(struct small *small, uint32_t count);
/* The best cut of `count` boxes at any position of order[0], along axes where not all centroids are
   equal. Its cost is infinite where there is none. */
struct small_cut small_find(const struct small *small, uint32_t count, f4 scale);
/* Grows the subtree over the boxes of `range`. Sweeps over every position along order[0] that
   separates centroids. */
void small_grow(struct small *small, const struct builder *builder,
                const struct build_output *output, const struct build_range *range);

#endif

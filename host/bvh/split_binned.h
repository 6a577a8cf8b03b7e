/* Equal bins. */
#ifndef BVH_SPLIT_BINNED_H
#define BVH_SPLIT_BINNED_H

#include "bvh/build.h"

/* Bin of a centroid: (centroid - origin) * scale, truncated. Partitioning evaluates the very same
   expression, so a record never lands on the other side of where it was counted. */
struct bin_grid {
    f4 origin, scale, last;
    uint32_t bins;
};

struct bin_plane {
    struct bin_grid grid;
    uint32_t axis, bin;  /* records of bins below `bin` go left */
    float cost;          /* relative to one primitive of the node's scaled area */
    uint32_t left_count; /* and the boxes of both sides, if the cost is below infinity */
    struct build_box side[2];
};

/* The best of equally spaced planes on all axes; of infinite cost where none separates anything. */
void bins_find(const struct build_record *records, const struct build_range *range, uint32_t bins,
               f4 scale, uint32_t thread_count, struct bin_plane *plane);

static inline f4 bin_grid_position(const struct bin_grid *grid, f4 centroid)
{
    return f4_min(f4_mul(f4_sub(centroid, grid->origin), grid->scale), grid->last);
}

/* 1: a record of this centroid goes left, else 0. */
static inline uint32_t bin_plane_left(const struct bin_plane *plane, f4 centroid)
{
    f4 position = bin_grid_position(&plane->grid, centroid);
    return f4_below(position, f4_splat((float)plane->bin)) >> plane->axis & 1u;
}

/* builder->split: bins_find, and partitions. */
enum build_choice split_binned(const struct builder *builder, const struct build_range *range,
                               uint32_t thread_count, void *scratch, struct build_halves *halves);

#endif

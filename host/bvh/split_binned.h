/* Splits between bins of equal width. */
#ifndef BVH_SPLIT_BINNED_H
#define BVH_SPLIT_BINNED_H

#include "bvh/build.h"

/* The bin of a centroid is (centroid - origin) * scale, truncated. Partitioning evaluates the same
   expression as counting, so a record always goes to the side where it was counted. */
struct bin_grid {
    f4 origin, scale, last;
    uint32_t bins;
};

struct bin_plane {
    struct bin_grid grid;
    uint32_t axis, bin;  /* records of bins below `bin` go left */
    float cost;          /* scaled half area times records, summed over both sides */
    uint32_t left_count; /* set, as `side` is, only where the cost is below infinity */
    struct build_box side[2];
};

/* The best of equally spaced planes on all axes; its cost is infinite where no plane separates
   anything. */
void bins_find(const struct build_record *records, const struct build_range *range, uint32_t bins,
               f4 scale, uint32_t thread_count, struct bin_plane *plane);

static inline f4 bin_grid_position(const struct bin_grid *grid, f4 centroid)
{
    return f4_min((centroid - grid->origin) * grid->scale, grid->last);
}

/* 1: a record with this centroid goes left; 0: right. */
static inline uint32_t bin_plane_left(const struct bin_plane *plane, f4 centroid)
{
    f4 position = bin_grid_position(&plane->grid, centroid);
    return f4_below(position, f4_splat((float)plane->bin)) >> plane->axis & 1u;
}

/* A function for builder->split: calls bins_find and partitions the records. */
enum build_choice split_binned(const struct builder *builder, const struct build_range *range,
                               uint32_t thread_count, void *scratch, struct build_halves *halves);

#endif

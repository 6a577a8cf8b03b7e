/* Object splits: every reference goes whole to one half. */
#include <math.h>
#include <string.h>

#include "bvh/records.h"
#include "bvh/spatial_object.h"

enum { BINS = 16 };

/* Finds the plane for few references. They are put in the order of their primitives first, which
   all differ, so that the order of equal centroids is fixed. */
static void few_find(const struct build_record *records, uint32_t count, f4 scale,
                     struct object_plane *plane)
{
    uint8_t *index = plane->index;
    for (uint32_t i = 0; i < count; ++i) {
        uint32_t at = i;
        for (; at > 0 && records[index[at - 1]].primitive > records[i].primitive; --at)
            index[at] = index[at - 1];
        index[at] = (uint8_t)i;
    }
    for (uint32_t i = 0; i < count; ++i)
        small_put(&plane->small, i, &records[index[i]]);
    small_sort(&plane->small, count);
    plane->cut = small_find(&plane->small, count, scale);
    plane->cost = plane->cut.cost;
    plane->side[0] = plane->side[1] = build_box_empty();
    for (uint32_t i = 0; i < count; ++i) {
        struct build_box *side = &plane->side[i >= plane->cut.left_count];
        uint32_t box = plane->small.order[0][plane->cut.axis][i];
        *side = build_box_unite(*side, plane->small.box[box]);
    }
}

static void few_apply(struct build_record *records, uint32_t count,
                      const struct object_plane *plane)
{
    struct build_record moved[BUILD_SMALL];
    memcpy(moved, records, count * sizeof *records);
    for (uint32_t i = 0; i < count; ++i)
        records[i] = moved[plane->index[plane->small.order[0][plane->cut.axis][i]]];
}

static void bins_apply(struct build_record *records, uint32_t count, const struct bin_plane *plane)
{
    uint32_t i = 0, j = count;
    while (i < j) {
        if (bin_plane_left(plane, build_centroid(build_record_box(&records[i]))))
            ++i;
        else
            build_records_swap(&records[i], &records[--j]);
    }
}

void object_find(const struct build_record *records, const struct build_range *range, f4 scale,
                 struct object_plane *plane)
{
    plane->cost = INFINITY;
    if (!(build_area(range->bounds.box, scale) > 0.0f))
        return;
    if (range->count <= BUILD_SMALL) {
        few_find(records, range->count, scale, plane);
        return;
    }
    bins_find(records, range, BINS, scale, 1, &plane->bins);
    plane->cost = plane->bins.cost;
    memcpy(plane->side, plane->bins.side, sizeof plane->side);
}

void object_apply(struct build_record *records, uint32_t count, const struct object_plane *plane,
                  struct build_halves *halves)
{
    if (count <= BUILD_SMALL)
        few_apply(records, count, plane);
    else
        bins_apply(records, count, &plane->bins);
    halves->count[0] = count <= BUILD_SMALL ? plane->cut.left_count : plane->bins.left_count;
    records_bound(records, count, halves);
}

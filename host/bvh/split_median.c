/* Splits at the object median, which looks at no cost and always succeeds. Other builders use it
   where SAH finds no plane that separates anything, and to bound the depth. */
#include <string.h>

#include "bvh/build.h"
#include "bvh/records.h"

/* The key that records are ordered by. All keys differ, so the median does not depend on the order
   of the records. */
static uint64_t record_key(const struct build_record *record, uint32_t axis)
{
    return (uint64_t)build_ordered_bits(build_centroid_along(record, axis)) << 32 |
           record->primitive;
}

static void insertion_sort(struct build_record *records, uint32_t count, uint32_t axis)
{
    for (uint32_t i = 1; i < count; ++i) {
        struct build_record moved = records[i];
        uint64_t key = record_key(&moved, axis);
        uint32_t at = i;
        for (; at > 0 && record_key(&records[at - 1], axis) > key; --at)
            records[at] = records[at - 1];
        records[at] = moved;
    }
}

/* The key that has `rank` smaller ones, found digit by digit: in linear time for every input. */
static uint64_t select_key(const struct build_record *records, uint32_t count, uint32_t axis,
                           uint32_t rank)
{
    uint64_t prefix = 0;
    for (int shift = 56; shift >= 0; shift -= 8) {
        uint32_t histogram[256] = {0};
        uint64_t above = shift == 56 ? 0 : ~(uint64_t)0 << (shift + 8);
        for (uint32_t i = 0; i < count; ++i) {
            uint64_t key = record_key(&records[i], axis);
            if ((key & above) == prefix)
                ++histogram[key >> shift & 255];
        }
        uint32_t digit = 0;
        while (rank >= histogram[digit])
            rank -= histogram[digit++];
        prefix |= (uint64_t)digit << shift;
    }
    return prefix;
}

static void partition(struct build_record *records, uint32_t count, uint32_t axis, uint64_t key)
{
    uint32_t i = 0, j = count;
    while (i < j) {
        if (record_key(&records[i], axis) < key)
            ++i;
        else
            build_records_swap(&records[i], &records[--j]);
    }
}

void split_median(const struct builder *builder, const struct build_range *range, void *scratch,
                  struct build_halves *halves)
{
    enum { SMALL = 24 };
    struct build_record *own = builder->records + range->first;
    uint32_t count = range->count, left = count / 2;
    uint32_t axis = build_widest_axis(range->bounds.centroids.hi - range->bounds.centroids.lo);
    (void)scratch;
    if (count <= SMALL)
        insertion_sort(own, count, axis);
    else
        partition(own, count, axis, select_key(own, count, axis, left));
    halves->count[0] = left;
    records_bound(own, count, halves);
}

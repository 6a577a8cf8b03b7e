/* The object median: no cost, no failure. Also what remains when SAH sees nothing to separate, and
   what bounds the depth. */
#include <string.h>

#include "bvh/build.h"

/* Floats in the order of unsigned integers. */
static uint32_t ordered_bits(float value)
{
    uint32_t bits;
    value += 0.0f; /* one zero */
    memcpy(&bits, &value, sizeof bits);
    return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

/* All keys differ, so the median is the same whatever the order of the records. */
static uint64_t record_key(const struct build_record *record, uint32_t axis)
{
    float centroid = record->lo[axis] * 0.25f + record->hi[axis] * 0.25f;
    return (uint64_t)ordered_bits(centroid) << 32 | record->primitive;
}

static uint32_t widest_axis(const struct build_bounds *bounds)
{
    alignas(16) float extent[4];
    f4_store(extent, f4_sub(bounds->centroid_hi, bounds->centroid_lo));
    uint32_t axis = extent[1] > extent[0] ? 1 : 0;
    return extent[2] > extent[axis] ? 2 : axis;
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

/* The key with `rank` smaller ones, digit by digit: linear for every input. */
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
        if (record_key(&records[i], axis) < key) {
            ++i;
            continue;
        }
        --j;
        struct build_record moved = records[j];
        records[j] = records[i];
        records[i] = moved;
    }
}

void split_median(struct build_record *records, const struct build_range *range,
                  uint32_t *left_count, struct build_bounds halves[2])
{
    enum { SMALL = 24 };
    struct build_record *own = records + range->first;
    uint32_t axis = widest_axis(&range->bounds), left = range->count / 2;
    if (range->count <= SMALL)
        insertion_sort(own, range->count, axis);
    else
        partition(own, range->count, axis, select_key(own, range->count, axis, left));
    halves[0] = halves[1] = build_bounds_empty();
    for (uint32_t i = 0; i < range->count; ++i)
        build_bounds_add(&halves[i >= left], build_record_lo(&own[i]), build_record_hi(&own[i]));
    *left_count = left;
}

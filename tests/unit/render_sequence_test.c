/* The sequence of sample points: its distribution, alone and in pairs of dimensions. */
#include "picture/sequence.h"
#include "unit.h"

enum { LEVELS = 6, POINTS = 1 << (2 * LEVELS) };

/* The index of the part, of 2^bits equal parts, that a coordinate is in. */
static uint32_t part_of(uint32_t place, uint32_t bits)
{
    return bits ? place >> (32 - bits) : 0;
}

/* Whether, for every i, each box of a grid with 2^i columns and 2^(2 level - i) rows has exactly
   one of the 4^level points from `first` on. */
static bool fills_all_boxes(uint32_t first, uint32_t level)
{
    static bool taken[POINTS];
    uint32_t count = 1u << (2 * level);
    for (uint32_t columns = 0; columns <= 2 * level; ++columns) {
        uint32_t rows = 2 * level - columns;
        memset(taken, 0, count * sizeof *taken);
        for (uint32_t i = first; i < first + count; ++i) {
            uint32_t xy[2];
            sequence_point(i, xy);
            uint32_t box = part_of(xy[0], columns) << rows | part_of(xy[1], rows);
            if (taken[box])
                return false;
            taken[box] = true;
        }
    }
    return true;
}

/* The first 4^k of the sequence, and all blocks behind them, up to what 4096 samples of 64 points
 * take. */
TEST(blocks_fill_all_boxes)
{
    for (uint32_t level = 0; level <= LEVELS; ++level) {
        uint32_t count = 1u << (2 * level), step = level < 3 ? 17 : 3;
        for (uint32_t block = 0; block * count < POINTS * 64u; block += step)
            assert_true(fills_all_boxes(block * count, level));
    }
    assert_false(fills_all_boxes(2, 1)); /* these are not one block */
}

/* The mean of the first 4, 16, ... points is near the middle; more points are nearer. */
TEST(points_lean_to_no_side)
{
    uint64_t sum[2] = {0, 0};
    for (uint32_t i = 0, count = 1; i < POINTS; ++i) {
        uint32_t xy[2];
        sequence_point(i, xy);
        sum[0] += xy[0], sum[1] += xy[1];
        for (int c = 0; i + 1 == count && c < 2; ++c) {
            double off = (double)sum[c] / count * 0x1p-32 - 0.5;
            print_message("  of %u: %+.5f\n", count, off);
            assert_true(count == 1 ? off == 0.0 : fabs(off) < 0.2 / count);
        }
        count *= i + 1 == count ? 4 : 1;
    }
}

/* ---- Samples ---- */

/* Where sample `index` is on something. */
static void pixel_of(uint32_t index, uint32_t xy[2])
{
    sequence_point(index, xy);
}

static void lens_of(uint32_t index, uint32_t xy[2])
{
    sequence_point(sequence_lens(index), xy);
}

static void light_of(uint32_t index, uint32_t xy[2])
{
    sequence_point(sequence_light(index), xy);
}

/* The first 4^k samples take the first 4^k points, in another order, so that they fill all boxes
   too; and each later block of 4^k samples takes one block of points. */
TEST(samples_keep_blocks)
{
    uint32_t (*const orders[])(uint32_t) = {sequence_lens, sequence_light};
    for (int o = 0; o < 2; ++o) {
        static bool taken[POINTS];
        memset(taken, 0, sizeof taken);
        for (uint32_t i = 0; i < POINTS; ++i) {
            uint32_t at = orders[o](i);
            assert_true(at < POINTS && !taken[at]);
            taken[at] = true;
            for (uint32_t level = 0; level <= LEVELS; ++level)
                assert_int_equal(at >> (2 * level),
                                 orders[o](i >> (2 * level) << (2 * level)) >> (2 * level));
            for (uint32_t level = 0; level <= LEVELS && i >> (2 * level) == 0; ++level)
                assert_int_equal(at >> (2 * level), 0);
        }
    }
}

/* Split both domains of a pair, say pixel and lens, into 4^k squares: each of the first 16^k
   samples has another combination of a square of the one with a square of the other. */
TEST(squares_meet_once)
{
    void (*const places[])(uint32_t, uint32_t[2]) = {pixel_of, lens_of, light_of};
    for (uint32_t bits = 1; bits <= 3; ++bits) {
        for (int pair = 0; pair < 3; ++pair) {
            static bool taken[POINTS];
            uint32_t count = 1u << (4 * bits);
            memset(taken, 0, sizeof taken);
            for (uint32_t i = 0; i < count; ++i) {
                uint32_t a[2], b[2], cell = 0;
                places[pair](i, a);
                places[(pair + 1) % 3](i, b);
                for (int c = 0; c < 2; ++c)
                    cell = (cell << bits | part_of(a[c], bits)) << bits | part_of(b[c], bits);
                assert_false(taken[cell]);
                taken[cell] = true;
            }
        }
    }
}

/* Where samples are: one sequence of points for the pixel, the lens and flat emitters. The first is
   the middle of the square. Of the first 4^k one is in each of 4^k columns, in each of as many
   rows, and in each box of 2^i columns and 2^(2k - i) rows, so in each square of a grid of 2^k x
   2^k; so are those of every later block of 4^k whose first index is a multiple of that. */
#include "picture/sequence.h"

static uint32_t reverse_bits(uint32_t value)
{
    uint32_t reversed = 0;
    for (int i = 0; i < 32; ++i)
        reversed |= (value >> i & 1u) << (31 - i);
    return reversed;
}

/* The binomial coefficients modulo 2 times the index: digits of Sobol's second coordinate (1967),
   the lowest bit first; those of the first are the index itself. */
static uint32_t rows_of(uint32_t index)
{
    index ^= index >> 1 & 0x55555555u;
    index ^= index >> 2 & 0x33333333u;
    index ^= index >> 4 & 0x0f0f0f0fu;
    index ^= index >> 8 & 0x00ff00ffu;
    return index ^ index >> 16;
}

/* Sobol's points are at corners of boxes, and the first few lean to one side. So digits are turned
   round, each with regard to those before it alone (Owen 1995), which keeps one point to a box. The
   first digit always is, which puts the first point in the middle; digit i of the next four where
   `turns` has bit 2^i + (the i digits before it); those behind by turns, which is two thirds of the
   way from one corner to the other. */
static uint32_t place_of(uint32_t digits, uint64_t turns)
{
    uint32_t flips = digits & 63u ? 0x55555541u : 1u;
    for (uint32_t i = 2; i < 6; ++i)
        flips |= (uint32_t)(turns >> ((1u << i) + (digits & ((1u << i) - 1u))) & 1u) << i;
    return reverse_bits(digits ^ flips);
}

/* The turns are those of least error, of many tried at random, at straight edges through 3 x 3
   pixels, for 4, 16 and 64 samples (docs/effects.md). */
void sequence_point(uint32_t index, uint32_t xy[2])
{
    xy[0] = place_of(index, 0x21a3e51a026472e0u);
    xy[1] = place_of(rows_of(index), 0x087cd066372c3e00u);
}

static uint32_t reorder(const uint16_t columns[SEQUENCE_BITS], uint32_t sample)
{
    uint32_t index = 0;
    for (int i = 0; i < SEQUENCE_BITS; ++i)
        index ^= sample >> i & 1u ? columns[i] : 0u;
    return index;
}

/* Found by trying at random, two columns after two: of the first 16 samples each has a quarter of
   the pixel and of the lens of its own, so have 256 with sixteenths, 4096 with sixty-fourths; so it
   is with the pixel and the emitter, and with the lens and the emitter. */
uint32_t sequence_lens(uint32_t sample)
{
    static const uint16_t columns[SEQUENCE_BITS] = {0x2,  0x1,  0xf,   0x8,   0x31,  0x23,
                                                    0x6a, 0xd7, 0x17d, 0x2ae, 0xb0a, 0xf1b};
    return reorder(columns, sample);
}

uint32_t sequence_light(uint32_t sample)
{
    static const uint16_t columns[SEQUENCE_BITS] = {0x2,  0x3,  0xa,   0x7,   0x29,  0x32,
                                                    0xa9, 0x45, 0x300, 0x104, 0xebd, 0x412};
    return reorder(columns, sample);
}

/* The places of samples: one sequence of points in the unit square for the pixel, the lens and flat
   emitters. The first point is the middle. Divide the square into any grid of 2^i x 2^(2k - i)
   equal boxes (rows, columns and squares among them): each box has one of the first 4^k points. The
   same holds for every later block of 4^k points whose first index is a multiple of 4^k. */
#include "picture/sequence.h"

static uint32_t reverse_bits(uint32_t value)
{
    uint32_t reversed = 0;
    for (int i = 0; i < 32; ++i)
        reversed |= (value >> i & 1u) << (31 - i);
    return reversed;
}

/* The digits, lowest bit first, of the second coordinate of Sobol's sequence (1967): the matrix of
   binomial coefficients modulo 2 times the index. The digits of the first coordinate are the index
   itself. */
static uint32_t rows_of(uint32_t index)
{
    index ^= index >> 1 & 0x55555555u;
    index ^= index >> 2 & 0x33333333u;
    index ^= index >> 4 & 0x0f0f0f0fu;
    index ^= index >> 8 & 0x00ff00ffu;
    return index ^ index >> 16;
}

/* Sobol's points lie at corners of boxes, and the first few are not centred. So digits are flipped
   depending only on the digits before them (Owen 1995), which keeps one point in each box. Digit 0
   is always flipped, which puts the first point in the middle. Digits 2 to 5 are flipped where
   `turns` has bit 2^i + (the i digits before digit i). Digit 1 is not flipped. From digit 6 on
   every second digit is flipped, unless the first six are 0, which places a point at two thirds
   between two corners of its box. */
static uint32_t place_of(uint32_t digits, uint64_t turns)
{
    uint32_t flips = digits & 63u ? 0x55555541u : 1u;
    for (uint32_t i = 2; i < 6; ++i)
        flips |= (uint32_t)(turns >> ((1u << i) + (digits & ((1u << i) - 1u))) & 1u) << i;
    return reverse_bits(digits ^ flips);
}

/* The constants `turns` were found by random search: they have the smallest error at straight edges
   through 3 x 3 pixels, for 4, 16 and 64 samples (docs/effects.md). */
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

/* The columns were found by random search, two at a time. Divide pixel and lens into quarters each:
   every one of the 16 pairs of quarters has one of the first 16 samples. The same holds for 256
   samples with sixteenths and 4096 with sixty-fourths, and for pixel and emitter, and lens and
   emitter. */
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

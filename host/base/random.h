/* splitmix64: Steele, Lea and Flood 2014, "Fast splittable pseudorandom number generators". A
   stream is one 64-bit number, which starts as the seed; its numbers are the same on every machine.
   Compilers evaluate operands and arguments in any order, so no expression may draw twice. */
#ifndef BASE_RANDOM_H
#define BASE_RANDOM_H

#include <stdint.h>

/* The constant that splitmix64 adds to the state for each number. */
#define SPLITMIX64_STEP UINT64_C(0x9e3779b97f4a7c15)

static inline uint64_t splitmix64(uint64_t *state)
{
    uint64_t z = *state += SPLITMIX64_STEP;
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

/* [0, 1), 53 bits */
static inline double splitmix64_unit(uint64_t *state)
{
    return (double)(splitmix64(state) >> 11) * 0x1p-53;
}

#endif

/* Random numbers of tests: the same on every machine. */
#ifndef TESTS_RANDOM_FIXTURE_H
#define TESTS_RANDOM_FIXTURE_H

#include <stdint.h>

static uint64_t random_state;

/* splitmix64: Steele, Lea and Flood 2014 */
static inline uint32_t random_bits(void)
{
    random_state += 0x9e3779b97f4a7c15u;
    uint64_t z = random_state;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return (uint32_t)(z >> 32);
}

/* [0, 1) */
static inline float random_float(void)
{
    return (float)(random_bits() >> 8) * 0x1p-24f;
}

#endif

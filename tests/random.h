/* The random numbers of all tests: the same on every machine. The state of a stream is one 64-bit
   number, at first its seed, which every function advances; any two seeds give unrelated streams.
   Draw at most one number per expression, since the order of evaluation is the compiler's. */
#ifndef TESTS_RANDOM_H
#define TESTS_RANDOM_H

#include <stdint.h>

/* splitmix64 (Steele, Lea and Flood 2014) without its last step, which changes the lower half. */
static inline uint64_t random_mix(uint64_t *state)
{
    *state += UINT64_C(0x9e3779b97f4a7c15);
    uint64_t z = *state;
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    return (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
}

static inline uint32_t random_bits(uint64_t *state)
{
    return (uint32_t)(random_mix(state) >> 32);
}

static inline uint64_t random_bits64(uint64_t *state)
{
    uint64_t z = random_mix(state);
    return z ^ z >> 31;
}

/* An integer in [0, count). */
static inline uint32_t random_below(uint64_t *state, uint32_t count)
{
    return random_bits(state) % count;
}

/* A number in [0, 1) of 53 bits. */
static inline double random_unit(uint64_t *state)
{
    return (double)(random_bits64(state) >> 11) * 0x1p-53;
}

/* [-1, 1) */
static inline double random_signed(uint64_t *state)
{
    return 2.0 * random_unit(state) - 1.0;
}

/* A number in [0, 1) of 24 bits. */
static inline float random_float(uint64_t *state)
{
    return (float)(random_bits(state) >> 8) * 0x1p-24f;
}

/* [-1, 1) */
static inline float random_float_signed(uint64_t *state)
{
    return 2.0f * random_float(state) - 1.0f;
}

/* A point of the cube [-1, 1)^3. */
static inline void random_vec3(uint64_t *state, double out[3])
{
    for (int k = 0; k < 3; ++k)
        out[k] = random_signed(state);
}

#endif

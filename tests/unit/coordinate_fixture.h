/* Random coordinates, from ordinary values to any float. */
#ifndef TESTS_COORDINATE_FIXTURE_H
#define TESTS_COORDINATE_FIXTURE_H

#include <math.h>
#include <string.h>

#include "base/vec.h"
#include "random_fixture.h"

static inline float in_cube(void)
{
    return random_float_signed(&random_state);
}

static inline struct vec3 point_of(float (*coordinate)(void))
{
    float x = coordinate(), y = coordinate(), z = coordinate();
    return vec3_make(x, y, z);
}

/* 10^-8 to 10^8. */
static inline float of_any_size(void)
{
    return in_cube() * (float)pow(10.0, 16.0 * (double)random_float(&random_state) - 8.0);
}

static inline float of_extreme_size(void)
{
    return ldexpf(in_cube(), (int)random_below(&random_state, 201) - 100);
}

static inline float of_grid(void)
{
    return (float)((int)random_below(&random_state, 7) - 3);
}

static inline float denormal(void)
{
    return ldexpf((float)((int)random_below(&random_state, 17) - 8), -149);
}

static inline float of_any_bits(void)
{
    float value;
    do {
        uint32_t bits = random_bits(&random_state);
        memcpy(&value, &bits, sizeof value);
    } while (!isfinite(value));
    return value;
}

#endif

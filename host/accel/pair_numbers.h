/* shaders/lib/pair_numbers.glsl in C, bit for bit. A pair is the sum of two floats, the second a
   rounding error of the first (Dekker 1971, "A floating-point technique for extending the available
   precision"). Products of pairs are off by 2^-45 of themselves, sums by 2^-46 of their terms. */
#ifndef ACCEL_PAIR_NUMBERS_H
#define ACCEL_PAIR_NUMBERS_H

#include <stdint.h>
#include <string.h>

#include "accel/intersect.h"

#define PAIR_RELATIVE (1.0f / 2199023255552.0f)             /* 2^-41 */
#define PAIR_ABSOLUTE (1.0f / 1208925819614629174706176.0f) /* 2^-80 */
#define PAIR_LEAST    (1.0f / 1099511627776.0f)             /* 2^-40 */

struct pair {
    float high, low;
};

struct pair_vector {
    struct pair x, y, z;
};

/* Exact (Knuth's two-sum). */
static inline struct pair pair_sum(float a, float b)
{
    float s = a + b, from_b = s - a;
    return (struct pair){s, (a - (s - from_b)) + (b - from_b)};
}

static inline struct pair pair_split(float a)
{
    float c = 4097.0f * a, high = c - (c - a);
    return (struct pair){high, a - high};
}

/* Exact, but for underflow. */
static inline struct pair pair_product(float a, float b)
{
    struct pair as = pair_split(a), bs = pair_split(b);
    float p = a * b;
    float error = ((as.high * bs.high - p) + as.high * bs.low + as.low * bs.high) + as.low * bs.low;
    return (struct pair){p, error};
}

static inline struct pair pair_times(struct pair a, struct pair b)
{
    struct pair p = pair_product(a.high, b.high);
    return pair_sum(p.high, p.low + (a.high * b.low + a.low * b.high));
}

static inline struct pair pair_plus(struct pair a, struct pair b)
{
    struct pair s = pair_sum(a.high, b.high);
    return pair_sum(s.high, s.low + (a.low + b.low));
}

static inline struct pair pair_minus(struct pair a, struct pair b)
{
    return pair_plus(a, (struct pair){-b.high, -b.low});
}

/* Exact. */
static inline struct pair_vector pair_difference(struct vec3 a, struct vec3 b)
{
    return (struct pair_vector){pair_sum(a.x, -b.x), pair_sum(a.y, -b.y), pair_sum(a.z, -b.z)};
}

static inline struct vec3 pair_magnitudes(const struct pair_vector *v)
{
    return (struct vec3){fabsf(v->x.high), fabsf(v->y.high), fabsf(v->z.high)};
}

static inline float pair_largest(const struct pair_vector *v)
{
    return vec3_largest_magnitude(pair_magnitudes(v));
}

static inline struct pair_vector pair_cross(const struct pair_vector *a,
                                            const struct pair_vector *b)
{
    return (struct pair_vector){pair_minus(pair_times(a->y, b->z), pair_times(a->z, b->y)),
                                pair_minus(pair_times(a->z, b->x), pair_times(a->x, b->z)),
                                pair_minus(pair_times(a->x, b->y), pair_times(a->y, b->x))};
}

static inline struct pair pair_dot(const struct pair_vector *a, const struct pair_vector *b)
{
    return pair_plus(pair_plus(pair_times(a->x, b->x), pair_times(a->y, b->y)),
                     pair_times(a->z, b->z));
}

static inline int length_exponent(float largest)
{
    uint32_t bits;
    memcpy(&bits, &largest, sizeof bits);
    int exponent = (int)(bits >> 23 & 255) - 127;
    return exponent < -100 ? -100 : exponent > 100 ? 100 : exponent;
}

static inline float power_of_two(int exponent)
{
    uint32_t bits = (uint32_t)(exponent + 127) << 23;
    float power;
    memcpy(&power, &bits, sizeof power);
    return power;
}

static inline void pair_scale(struct pair_vector *v, float power)
{
    *v = (struct pair_vector){{v->x.high * power, v->x.low * power},
                              {v->y.high * power, v->y.low * power},
                              {v->z.high * power, v->z.low * power}};
}

/* And how far it may be off. */
struct bounded_pair {
    struct pair value;
    float error;
};

/* t = top / bottom, rounded to nearest. False: not sure. */
static inline bool round_ratio(struct bounded_pair top, struct bounded_pair bottom, float *t)
{
    float first = top.value.high / bottom.value.high;
    struct pair back = pair_product(first, bottom.value.high);
    float rest =
        ((top.value.high - back.high) - back.low) + (top.value.low - first * bottom.value.low);
    struct pair both = pair_sum(first, rest / bottom.value.high);
    float size = fabsf(bottom.value.high);
    float error = top.error / size + fabsf(both.high) * (bottom.error / size + PAIR_RELATIVE);
    uint32_t bits;
    memcpy(&bits, &both.high, sizeof bits);
    bits = both.low > 0.0f ? bits + 1 : bits - 1; /* t > 0 */
    float next;
    memcpy(&next, &bits, sizeof next);
    *t = both.high;
    return both.high > PAIR_LEAST && size > PAIR_LEAST &&
           fabsf(both.low) + error < 0.5f * fabsf(next - both.high);
}

static inline bool is_fit(float largest)
{
    return largest > 1.0f / 1099511627776.0f && largest < 1099511627776.0f;
}

#endif

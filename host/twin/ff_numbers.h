/* shaders/lib/ff_numbers.glsl in C, bit for bit: float-float arithmetic. A number is the sum of two
   floats, of which the second is a rounding error of the first (Dekker 1971, "A floating-point
   technique for extending the available precision"). Products have a relative error of 2^-45, sums
   one of 2^-46 of their terms. */
#ifndef TWIN_FF_NUMBERS_H
#define TWIN_FF_NUMBERS_H

#include "twin/intersect.h"

#define FF_RELATIVE (1.0f / 2199023255552.0f)             /* 2^-41 */
#define FF_ABSOLUTE (1.0f / 1208925819614629174706176.0f) /* 2^-80 */
#define FF_MIN      (1.0f / 1099511627776.0f)             /* 2^-40 */

struct ff {
    float high, low;
};

struct ff_vector {
    struct ff x, y, z;
};

/* Exact (Knuth's two-sum). */
static inline struct ff ff_sum(float a, float b)
{
    float s = a + b, from_b = s - a;
    return (struct ff){s, (a - (s - from_b)) + (b - from_b)};
}

static inline struct ff ff_split(float a)
{
    float c = 4097.0f * a, high = c - (c - a);
    return (struct ff){high, a - high};
}

/* Exact, but for underflow. */
static inline struct ff ff_product(float a, float b)
{
    struct ff as = ff_split(a), bs = ff_split(b);
    float p = a * b;
    float error = ((as.high * bs.high - p) + as.high * bs.low + as.low * bs.high) + as.low * bs.low;
    return (struct ff){p, error};
}

static inline struct ff ff_times(struct ff a, struct ff b)
{
    struct ff p = ff_product(a.high, b.high);
    return ff_sum(p.high, p.low + (a.high * b.low + a.low * b.high));
}

static inline struct ff ff_plus(struct ff a, struct ff b)
{
    struct ff s = ff_sum(a.high, b.high);
    return ff_sum(s.high, s.low + (a.low + b.low));
}

static inline struct ff ff_minus(struct ff a, struct ff b)
{
    return ff_plus(a, (struct ff){-b.high, -b.low});
}

/* Exact. */
static inline struct ff_vector ff_difference(struct vec3 a, struct vec3 b)
{
    return (struct ff_vector){ff_sum(a.x, -b.x), ff_sum(a.y, -b.y), ff_sum(a.z, -b.z)};
}

static inline struct vec3 ff_magnitudes(const struct ff_vector *v)
{
    return (struct vec3){fabsf(v->x.high), fabsf(v->y.high), fabsf(v->z.high)};
}

static inline float ff_largest(const struct ff_vector *v)
{
    return vec3_largest_magnitude(ff_magnitudes(v));
}

static inline struct ff_vector ff_cross(const struct ff_vector *a, const struct ff_vector *b)
{
    return (struct ff_vector){ff_minus(ff_times(a->y, b->z), ff_times(a->z, b->y)),
                              ff_minus(ff_times(a->z, b->x), ff_times(a->x, b->z)),
                              ff_minus(ff_times(a->x, b->y), ff_times(a->y, b->x))};
}

static inline struct ff ff_dot(const struct ff_vector *a, const struct ff_vector *b)
{
    return ff_plus(ff_plus(ff_times(a->x, b->x), ff_times(a->y, b->y)), ff_times(a->z, b->z));
}

static inline int length_exponent(float largest)
{
    int exponent = (int)(float_bits(largest) >> 23 & 255) - 127;
    return exponent < -100 ? -100 : exponent > 100 ? 100 : exponent;
}

static inline float power_of_two(int exponent)
{
    return float_of_bits((uint32_t)(exponent + 127) << 23);
}

static inline void ff_scale(struct ff_vector *v, float power)
{
    *v = (struct ff_vector){{v->x.high * power, v->x.low * power},
                            {v->y.high * power, v->y.low * power},
                            {v->z.high * power, v->z.low * power}};
}

/* A float-float number and a bound of its error. */
struct bounded_ff {
    struct ff value;
    float error;
};

/* t = top / bottom, rounded to nearest. False: it is not certain. */
static inline bool round_ratio(struct bounded_ff top, struct bounded_ff bottom, float *t)
{
    float first = top.value.high / bottom.value.high;
    struct ff back = ff_product(first, bottom.value.high);
    float rest =
        ((top.value.high - back.high) - back.low) + (top.value.low - first * bottom.value.low);
    struct ff both = ff_sum(first, rest / bottom.value.high);
    float size = fabsf(bottom.value.high);
    float error = top.error / size + fabsf(both.high) * (bottom.error / size + FF_RELATIVE);
    uint32_t bits = float_bits(both.high); /* t > 0 */
    float next = float_of_bits(both.low > 0.0f ? bits + 1 : bits - 1);
    *t = both.high;
    return both.high > FF_MIN && size > FF_MIN &&
           fabsf(both.low) + error < 0.5f * fabsf(next - both.high);
}

static inline bool is_fit(float largest)
{
    return largest > 1.0f / 1099511627776.0f && largest < 1099511627776.0f;
}

#endif

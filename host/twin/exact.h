/* shaders/lib/exact.glsl in C: whether and where a ray meets a triangle, as exact arithmetic on the
   given floats would find. The filter repeats the shader's operations one by one; the exact test is
   the same integer arithmetic, digit by digit, so that u and v have the same bits too. Method and
   bounds: docs/numerics-method.md, "exact". */
#ifndef TWIN_EXACT_H
#define TWIN_EXACT_H

#include "twin/intersect.h"

#define EXACT_UNIT  (1.0f / 16777216.0f)
#define EXACT_TINY  7.8886090522101181e-31f /* 2^-100: more than underflow can add */
#define EXACT_LARGE 1.2676506002282294e+30f

/* The part of the answer that floats can decide. The key is the exact t, rounded to nearest. */
struct exact_bounds {
    bool outside; /* surely missed */
    bool inside;  /* surely hit, and t, u, v are valid */
    float t, u, v;
    float lo, hi;     /* lo <= key <= hi if it is hit */
    float edge_error; /* error bound of the edge functions */
};

/* Vertices are relative to the ray's origin, as for intersect_triangle. */
void exact_filter(const struct ray_setup *ray, struct vec3 a, struct vec3 b, struct vec3 c,
                  struct exact_bounds *out);

struct exact_candidate {
    bool met; /* at t >= 0, in the closed triangle, not edge-on; false for keys above FLT_MAX */
    float key, u, v;
};

/* Decides exactly whether the ray meets the triangle. All coordinates must be finite. */
void exact_meet(struct vec3 origin, struct vec3 dir, struct vec3 v0, struct vec3 v1, struct vec3 v2,
                struct exact_candidate *out);

/* ---- In integers ---- */

/* The value is m 2^(*exponent - 150), where the mantissa m has its sign in the top bit. */
static inline uint32_t exact_decode(float value, int32_t *exponent)
{
    uint32_t bits = float_bits(value), biased = bits >> 23 & 255u;
    *exponent = biased != 0 ? (int32_t)biased : 1;
    return (bits & 0x807fffffu) | (biased != 0 ? 0x800000u : 0u);
}

/* The sign of an integer in digits. `carry` is the carry out of the last digit, `some` the or of
   all digits. */
static inline int32_t exact_sign(int32_t carry, int32_t some)
{
    return carry < 0 ? -1 : (carry | some) != 0 ? 1 : 0;
}

#endif

// Sums and products of two floats without error: the rounded result, and its rounding error (Dekker
// 1971, "A floating-point technique for extending the available precision"). twin/ff_numbers.h is
// this file in C.
#ifndef LIB_FF_SUMS_GLSL
#define LIB_FF_SUMS_GLSL

vec2 ff_sum(float a, float b) // exact (Knuth's two-sum)
{
    precise float s = a + b;
    precise float from_b = s - a;
    precise float error = (a - (s - from_b)) + (b - from_b);
    return vec2(s, error);
}

vec2 ff_split(float a)
{
    precise float c = 4097.0 * a;
    precise float high = c - (c - a);
    precise float low = a - high;
    return vec2(high, low);
}

vec2 ff_product(float a, float b) // exact, but for underflow
{
    vec2 as = ff_split(a), bs = ff_split(b);
    precise float p = a * b;
    precise float error = ((as.x * bs.x - p) + as.x * bs.y + as.y * bs.x) + as.y * bs.y;
    return vec2(p, error);
}

#endif

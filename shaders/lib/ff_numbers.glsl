// Float-float arithmetic: a number is the sum of two floats, of which the second is a rounding
// error of the first (Dekker 1971, "A floating-point technique for extending the available
// precision"). Products have a relative error of 2^-45, sums one of 2^-46 of their terms.
// twin/ff_numbers.h is this file in C.
#ifndef LIB_FF_NUMBERS_GLSL
#define LIB_FF_NUMBERS_GLSL

#include "exact.glsl"

const float FF_RELATIVE = 1.0 / 2199023255552.0; // 2^-41
const float FF_ABSOLUTE = 1.0 / 1208925819614629174706176.0; // 2^-80
const float FF_MIN = 1.0 / 1099511627776.0; // 2^-40

#include "ff_sums.glsl"

vec2 ff_times(vec2 a, vec2 b)
{
    vec2 p = ff_product(a.x, b.x);
    precise float low = p.y + (a.x * b.y + a.y * b.x);
    return ff_sum(p.x, low);
}

vec2 ff_plus(vec2 a, vec2 b)
{
    vec2 s = ff_sum(a.x, b.x);
    precise float low = s.y + (a.y + b.y);
    return ff_sum(s.x, low);
}

struct PairVector {
    vec2 x, y, z;
};

PairVector ff_difference(vec3 a, vec3 b) // exact
{
    return PairVector(ff_sum(a.x, -b.x), ff_sum(a.y, -b.y), ff_sum(a.z, -b.z));
}

vec3 magnitudes(PairVector v)
{
    return abs(vec3(v.x.x, v.y.x, v.z.x));
}

PairVector ff_cross(PairVector a, PairVector b)
{
    PairVector n;
    n.x = ff_plus(ff_times(a.y, b.z), -ff_times(a.z, b.y));
    n.y = ff_plus(ff_times(a.z, b.x), -ff_times(a.x, b.z));
    n.z = ff_plus(ff_times(a.x, b.y), -ff_times(a.y, b.x));
    return n;
}

vec2 ff_dot(PairVector a, PairVector b)
{
    return ff_plus(ff_plus(ff_times(a.x, b.x), ff_times(a.y, b.y)),
                     ff_times(a.z, b.z));
}

// The exponent of a finite length, limited to -100..100: divided by that power of two the length is
// 1 to 2.
int length_exponent(float largest)
{
    return clamp(int(floatBitsToUint(largest) >> 23 & 255u) - 127, -100, 100);
}

float power_of_two(int exponent) // -126..127
{
    return uintBitsToFloat(uint(exponent + 127) << 23);
}

PairVector ff_scaled(PairVector v, float power)
{
    return PairVector(v.x * power, v.y * power, v.z * power);
}

// t = top / bottom, rounded to nearest. False: it is not certain. Quotients need not be correctly
// rounded here: what remains is divided once more.
bool round_ratio(vec2 top, vec2 bottom, float top_error, float bottom_error, out float t)
{
    precise float first = top.x / bottom.x;
    vec2 back = ff_product(first, bottom.x);
    precise float rest = ((top.x - back.x) - back.y) + (top.y - first * bottom.y);
    precise float second = rest / bottom.x;
    vec2 both = ff_sum(first, second);
    precise float error = top_error / abs(bottom.x) +
                          abs(both.x) * (bottom_error / abs(bottom.x) + FF_RELATIVE);
    uint bits = floatBitsToUint(both.x);
    float next = uintBitsToFloat(both.y > 0.0 ? bits + 1u : bits - 1u); // t > 0
    precise float to_middle = 0.5 * abs(next - both.x);
    precise float off = abs(both.y) + error;
    t = both.x;
    return t > FF_MIN && abs(bottom.x) > FF_MIN && off < to_middle;
}

bool is_fit(float largest)
{
    return largest > 1.0 / 1099511627776.0 && largest < 1099511627776.0; // 2^-40, 2^40
}

#endif

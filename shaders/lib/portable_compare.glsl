// Bits and comparisons of floats: a part of portable.glsl.
#ifndef LIB_PORTABLE_COMPARE_GLSL
#define LIB_PORTABLE_COMPARE_GLSL

// True: the device's own comparisons and abs() are used, as they tell denormals from 0. NVIDIA's do
// not, though its sums and products do.
layout(constant_id = 2) const bool OWN_COMPARISON = true;

const uint INFINITE_BITS = 0x7f800000u, SIGN_BIT = 0x80000000u;

float portable_nan()
{
    return uintBitsToFloat(0x7fc00000u);
}

float portable_infinity()
{
    return uintBitsToFloat(INFINITE_BITS);
}

bool is_nan_bits(const uint bits)
{
    return (bits & ~SIGN_BIT) > INFINITE_BITS;
}

// 2^n, for n in -126..127.
float power_of_two(const int n)
{
    return uintBitsToFloat(uint(n + 127) << 23);
}

// x 2^n with one rounding, for 0.5 <= x < 2 and n in -150..128: of the two multiplications the
// first is exact.
float scaled(const float x, const int n)
{
    int first = n >> 1;
    return x * power_of_two(first) * power_of_two(n - first);
}

// ---- Comparisons ----

// Whether a difference is below 0. It is 0 for equal numbers only, as denormals are kept; negative
// ones have the bits of -2^-149 to those of -infinity.
bool is_below(const float difference)
{
    return floatBitsToUint(difference) - (SIGN_BIT + 1u) < INFINITE_BITS;
}

bool portable_less(const float x, const float y)
{
    return OWN_COMPARISON ? x < y : is_below(x - y);
}

// The device may call two numbers equal if both are denormals, or one is and the other is 0.
// Otherwise its answer is right.
bool portable_at_most(const float x, const float y)
{
    return x <= y && (OWN_COMPARISON || !is_below(y - x));
}

bool portable_equal(const float x, const float y)
{
    return x == y && (OWN_COMPARISON || !(is_below(x - y) || is_below(y - x)));
}

bool portable_unequal(const float x, const float y)
{
    return !portable_equal(x, y);
}

bool portable_more(const float x, const float y)
{
    return portable_less(y, x);
}

bool portable_at_least(const float x, const float y)
{
    return portable_at_most(y, x);
}

float portable_abs(const float x)
{
    return OWN_COMPARISON ? abs(x) : uintBitsToFloat(floatBitsToUint(x) & ~SIGN_BIT);
}

#endif

// Functions whose results Vulkan leaves to the driver, made of operations whose results it does
// not: sums, differences and products of floats, each rounded to nearest, and integers. Where
// `--portable` asks for it, host/shader/portable.c puts these functions into kernels in place of
// the driver's, by name and types of the arguments. So they alone decide the results.
//
// ulp: the distance of neighbouring floats at the exact result. The largest errors stated below are
// measured by device_portable_test; docs/numerics.md says over how many floats. NaN as an argument
// gives NaN with the bits 0x7fc00000. Statements about denormals hold on devices that keep them,
// which `--portable` asks for.
#ifndef LIB_PORTABLE_GLSL
#define LIB_PORTABLE_GLSL

#include "angles.glsl"
#include "ff_sums.glsl"

// Whether the device's own division and square root are rounded correctly: they then give the same
// bits as `divided` and `rooted`, and take less time. The other functions have only one form.
layout(constant_id = 0) const bool OWN_DIVISION = true;

#include "portable_compare.glsl"

// ---- Division and square root: rounded to nearest, ties to even, for all floats ----

// A finite float other than 0, without its sign: s 2^(exponent - 23), with s in 2^23..2^24 - 1. In
// integers, so that denormals are no special case.
struct Significand {
    uint s;
    int exponent;
};

Significand significand(const uint bits)
{
    uint exponent = bits >> 23, s = bits & 0x7fffffu;
    int shift = exponent == 0u ? 23 - findMSB(max(s, 1u)) : 0;
    return exponent == 0u ? Significand(s << uint(shift), -126 - shift)
                          : Significand(s | 0x800000u, int(exponent) - 127);
}

// 1..2
float significand_float(const uint s)
{
    return uintBitsToFloat((s & 0x7fffffu) | 0x3f800000u);
}

// The bits of (s + d) 2^exponent, rounded, for s in 2^24..2^26 - 1. d is 0, or between 0 and 1 if
// `more`. Denormals are rounded at their last bit; overflow gives infinity.
uint rounded_bits(const uint s, const bool more, const int exponent)
{
    int width = findMSB(s), power = exponent + width;
    uint cut = uint(clamp(width - 23 + max(-126 - power, 0), 1, 27));
    uint kept = s >> cut, rest = s & ((1u << cut) - 1u), middle = 1u << (cut - 1u);
    bool up = rest > middle || (rest == middle && (more || (kept & 1u) != 0u));
    uint bits = (power < -126 ? 0u : uint(power + 126) << 23) + kept + (up ? 1u : 0u);
    return power > 127 ? INFINITE_BITS : bits;
}

// x / y. The quotient of the significands, to 25 bits and more, is guessed in floats (Newton's
// steps from a line, Higham 2002, section 3.6) and then corrected to be exact: the remainder is an
// integer that fits into 32 bits, though its terms do not, since the guess is off by few units.
float divided(const float x, const float y)
{
    uint a = floatBitsToUint(x), b = floatBitsToUint(y), sign = (a ^ b) & SIGN_BIT;
    a &= ~SIGN_BIT;
    b &= ~SIGN_BIT;
    Significand n = significand(a), d = significand(b);
    float divisor = significand_float(d.s);
    float inverse = 1.41176471 - 0.470588235 * divisor; // off by at most 1/17
    inverse = inverse * (2.0 - divisor * inverse);
    inverse = inverse * (2.0 - divisor * inverse);
    inverse = inverse * (2.0 - divisor * inverse);
    uint q = uint(significand_float(n.s) * inverse * 33554432.0); // n.s 2^25 / d.s, off by 20 at
                                                                  // most
    int rest = int((n.s << 25) - q * d.s);
    int off = int(floor(float(rest) * (inverse * (1.0 / 8388608.0))));
    q += uint(off);
    rest -= off * int(d.s);
    int last = rest < 0 ? -1 : rest >= int(d.s) ? 1 : 0;
    q += uint(last);
    rest -= last * int(d.s);
    uint bits = rounded_bits(max(q, 1u << 24), rest != 0, n.exponent - d.exponent - 25);
    bits = a == INFINITE_BITS || b == 0u ? INFINITE_BITS : a == 0u || b == INFINITE_BITS ? 0u : bits;
    bool none = is_nan_bits(a) || is_nan_bits(b) || (a == b && (a == 0u || a == INFINITE_BITS));
    return none ? portable_nan() : uintBitsToFloat(bits | sign);
}

// The square root, by the same method: s s <= n < (s + 1) (s + 1) for the integer n, of 49 or 50
// bits. The result is never a denormal.
float rooted(const float x)
{
    uint a = floatBitsToUint(x);
    Significand of = significand(a & ~SIGN_BIT);
    uint odd = uint(of.exponent) & 1u, n = of.s << odd;
    float square = float(n) * (1.0 / 8388608.0); // 1..4
    float inverse = inverse_square_root(square);
    uint s = uint(square * inverse * 16777216.0); // off by at most 8
    int rest = int((n << 25) - s * s);
    int off = int(floor(float(rest) * (inverse * (1.0 / 33554432.0))));
    rest -= off * int(2u * s + uint(off));
    s += uint(off);
    int last = rest < 0 ? -1 : rest > int(2u * s) ? 1 : 0;
    rest -= last * int(2u * s + uint(last));
    s += uint(last);
    uint bits = rounded_bits(max(s, 1u << 24), rest != 0, (of.exponent - int(odd) - 48) / 2);
    bits = a == INFINITE_BITS || (a & ~SIGN_BIT) == 0u ? a : bits;
    bool none = is_nan_bits(a) || a > SIGN_BIT;
    return none ? portable_nan() : uintBitsToFloat(bits);
}

float portable_divide(const float x, const float y)
{
    if (OWN_DIVISION)
        return x / y;
    return divided(x, y);
}

float portable_sqrt(const float x)
{
    if (OWN_DIVISION)
        return sqrt(x);
    return rooted(x);
}

// Two roundings: 1.49 ulp. -infinity for -0, as in IEEE 754.
float portable_inversesqrt(const float x)
{
    return portable_divide(1.0, portable_sqrt(x));
}

// ---- Powers and logarithms ----

// 2^(x.x + x.y), for x.x in -150..128 and a small x.y, by a polynomial on -0.5..0.5 (Remez) whose
// relative error is 2^-34.
float exp2_of_pair(const vec2 x)
{
    float whole = floor(x.x + 0.5), f = x.x - whole;
    float p = (((((1.51961576e-05 * f + 0.000154667563) * f + 0.00133339351) * f + 0.00961803831) * f +
                0.0555041023) * f + 0.240226507) * f + 0.693147182;
    float r = f * p;
    return scaled(1.0 + (r + 0.693147182 * x.y * (1.0 + r)), int(whole));
}

// exp2_of_pair for any x: gives 0 or infinity where the result is no float.
float exp2_of(const vec2 x)
{
    float bounded = x.x < -150.0 ? -150.0 : x.x > 128.0 ? 128.0 : x.x;
    float y = exp2_of_pair(vec2(bounded, x.x == bounded ? x.y : 0.0));
    return x.x > 128.0 ? portable_infinity() : x.x < -150.0 ? 0.0 : y;
}

// 1.08 ulp. 0 below -150, infinite from 128 on.
float portable_exp2(const float x)
{
    return is_nan_bits(floatBitsToUint(x)) ? portable_nan() : exp2_of(vec2(x, 0.0));
}

const vec2 LOG2_E = vec2(1.44269502, 1.92596303e-08), LN_2 = vec2(0.693147182, -1.90465421e-09);

// 1.31 ulp.
float portable_exp(const float x)
{
    float bounded = x < -110.0 ? -110.0 : x > 90.0 ? 90.0 : x;
    vec2 p = ff_product(bounded, LOG2_E.x);
    float y = exp2_of(vec2(p.x, p.y + bounded * LOG2_E.y));
    return is_nan_bits(floatBitsToUint(x)) ? portable_nan() : y;
}

// log2(x) of a finite x > 0 as a float-float, with a relative error of 2^-30. x = 2^e m / c with m c in
// 0.866..1.156, where c has few bits, so that t = m c - 1 is exact; log(1 + t) = t - t^2 / 2 + t^3
// p(t), with the first two terms exact.
vec2 log2_ff(const float x)
{
    Significand of = significand(floatBitsToUint(x));
    float m = significand_float(of.s);
    bool upper = m >= 1.41421354;
    m = upper ? 0.5 * m : m;
    float e = float(of.exponent + (upper ? 1 : 0));
    float t = m - 1.0;
    vec2 part = vec2(0.0);
    if (m > 1.155) {
        t -= 0.25 * m;
        part = vec2(0.414978027, 5.94719349e-05); // -log2(3 / 4): e + part.x is exact
    } else if (m < 0.87) {
        t += 0.25 * m;
        part = vec2(-0.321960449, 3.23543318e-05); // -log2(5 / 4)
    }
    float p = ((((((0.1099879 * t - 0.128780693) * t + 0.142938733) * t - 0.166625991) * t + 0.199999377) *
                    t - 0.250000119) * t + 0.333333343);
    vec2 square = ff_product(t, t);
    vec2 ln = ff_sum(t, -0.5 * square.x);
    float low = ln.y + (square.x * t * p - 0.5 * square.y);
    vec2 scaled_ln = ff_product(ln.x, LOG2_E.x);
    vec2 sum = ff_sum(e + part.x, scaled_ln.x);
    return ff_sum(sum.x, sum.y + (part.y + (scaled_ln.y + (ln.x * LOG2_E.y + low * LOG2_E.x))));
}

// The logarithm of x where x is not a positive finite number; `usual` where it is.
float logarithm(const float x, const float usual)
{
    uint a = floatBitsToUint(x);
    bool none = is_nan_bits(a) || a > SIGN_BIT;
    float ends = (a & ~SIGN_BIT) == 0u ? -portable_infinity() : a == INFINITE_BITS ? x : usual;
    return none ? portable_nan() : ends;
}

// 0.53 ulp, as portable_log has. -infinity for 0 and -0, NaN for x < 0.
float portable_log2(const float x)
{
    return logarithm(x, log2_ff(x).x);
}

float portable_log(const float x)
{
    vec2 l = log2_ff(x);
    vec2 p = ff_product(l.x, LN_2.x);
    return logarithm(x, p.x + (p.y + (l.x * LN_2.y + l.y * LN_2.x)));
}

// 2.77 ulp. NaN for x < 0, which GLSL leaves undefined; 1 for y = 0 and for x = 1; else as in C.
float portable_pow(const float x, const float y)
{
    uint a = floatBitsToUint(x), b = floatBitsToUint(y);
    bool usual = a - 1u < INFINITE_BITS - 1u; // finite and above 0
    vec2 l = log2_ff(usual ? x : 1.0);
    float bounded = y > 1e10 ? 1e10 : y < -1e10 ? -1e10 : y;
    vec2 p = ff_product(l.x, bounded);
    float power = exp2_of(vec2(p.x, p.y + l.y * bounded));
    bool grows = ((a & ~SIGN_BIT) == 0u) == (b >= SIGN_BIT); // for x = 0 or infinity
    power = usual ? power : grows ? portable_infinity() : 0.0;
    bool none = is_nan_bits(a) || is_nan_bits(b) || a > SIGN_BIT;
    return (b & ~SIGN_BIT) == 0u || a == 0x3f800000u ? 1.0 : none ? portable_nan() : power;
}

// ---- Angles ----

const vec2 HALF_PI = vec2(1.57079637, -4.37113883e-08);

// 32 bits of 2 / pi, from bit number `first` on, counted down from the place 2^64.
uint two_over_pi(const int first)
{
    const uint digits[9] = uint[9](0u, 0u, 0xa2f9836eu, 0x4e441529u, 0xfc2757d1u, 0xf534ddc0u,
                                   0xdb629599u, 0x3c439041u, 0xfe5163abu);
    int word = first >> 5;
    uint shift = uint(first) & 31u;
    return shift == 0u ? digits[word] : digits[word] << shift | digits[word + 1] >> (32u - shift);
}

// Reduces an angle: x = (quarter + 4 k) pi / 2 + angle, |angle| <= pi / 4, the angle as a
// float-float.
// Payne and Hanek (1983): of the product with 2 / pi only the digits around the binary point are
// computed, in integers, 62 of them behind it.
struct Turned {
    vec2 angle;
    uint quarter;
};

Turned turned(const float x)
{
    uint bits = floatBitsToUint(x), size = bits & ~SIGN_BIT;
    bool negative = bits >= SIGN_BIT;
    if (size < 0x3f490fdcu) // pi / 4
        return Turned(vec2(x, 0.0), 0u);
    Significand of = significand(min(size, INFINITE_BITS - 1u));
    int first = of.exponent + 31;
    uint s = of.s << 8, high0, low0, high1, low1, carry;
    umulExtended(s, two_over_pi(first + 64), high0, low0);
    umulExtended(s, two_over_pi(first + 32), high1, low1);
    uint middle = uaddCarry(low1, high0, carry);
    uint top = s * two_over_pi(first) + high1 + carry; // quarters in its first two bits
    uint quarter = (top + 0x20000000u) >> 30;
    uint high = top << 2 | middle >> 30, low = middle << 2 | low0 >> 30; // -1/2..1/2, 64 bits
    bool below = high >= SIGN_BIT;
    low = below ? ~low + 1u : low;
    high = below ? ~high + (low == 0u ? 1u : 0u) : high;
    int zeros = 31 - findMSB(max(high, 1u));
    high = zeros == 0 ? high : high << uint(zeros) | low >> uint(32 - zeros);
    low <<= uint(zeros);
    float unit = power_of_two(-24 - zeros);
    vec2 f = vec2(float(high >> 8), float((high & 0xffu) << 16 | low >> 16) * (1.0 / 16777216.0)) * unit;
    vec2 p = ff_product(f.x, HALF_PI.x);
    vec2 angle = ff_sum(p.x, p.y + (f.x * HALF_PI.y + f.y * HALF_PI.x));
    return Turned(below != negative ? -angle : angle, negative ? 0u - quarter : quarter);
}

// x: sine, y: cosine.
vec2 sine_cosine(const float x)
{
    Turned t = turned(x);
    float r = t.angle.x, z = r * r;
    float s = (((2.71835029e-06 * z - 0.000198393391) * z + 0.00833332911) * z - 0.166666672);
    float c = (((-2.7301013e-07 * z + 2.48006018e-05) * z - 0.00138888881) * z + 0.0416666679);
    float sine = r + (t.angle.y * (1.0 - 0.5 * z) + r * z * s);
    float near = 1.0 - 0.5 * z;
    float cosine = near + (((1.0 - near) - 0.5 * z) + (z * z * c - r * t.angle.y));
    vec2 turn = (t.quarter & 1u) == 0u ? vec2(sine, cosine) : vec2(cosine, -sine);
    turn = (t.quarter & 2u) == 0u ? turn : -turn;
    turn.x = abs(x) < 1.0 / 4096.0 ? x : turn.x; // also for -0
    return (floatBitsToUint(x) & ~SIGN_BIT) >= INFINITE_BITS ? vec2(portable_nan()) : turn;
}

// 0.82 ulp, for angles of any size; NaN for infinite ones.
float portable_sin(const float x)
{
    return sine_cosine(x).x;
}

float portable_cos(const float x)
{
    return sine_cosine(x).y;
}

// 2.32 ulp.
float portable_tan(const float x)
{
    vec2 turn = sine_cosine(x);
    return portable_divide(turn.x, turn.y);
}

// The angle whose tangent is x, for x in 0..infinity. Where x is large, pi / 4 or pi / 2 is split
// off first.
float arc_tangent(const float x)
{
    bool large = x > 2.41421366, middle = x > 0.414213568;
    float above = large ? -1.0 : middle ? x - 1.0 : x, below = large ? x : middle ? x + 1.0 : 1.0;
    float t = middle ? portable_divide(above, below) : x;
    vec2 from = large ? HALF_PI : middle ? 0.5 * HALF_PI : vec2(0.0);
    float z = t * t;
    float p = ((((0.0484143645 * z - 0.0852730647) * z + 0.110547371) * z - 0.14282918) * z +
               0.199999407) * z - 0.333333343;
    return from.x + (t + (t * z * p + from.y));
}

// 1.88 ulp.
float portable_atan(const float x)
{
    uint bits = floatBitsToUint(x);
    float angle = arc_tangent(portable_abs(x));
    return is_nan_bits(bits) ? portable_nan() : bits >= SIGN_BIT ? -angle : angle;
}

// 2.21 ulp. As in C, the sign of a zero decides the side.
float portable_atan(const float y, const float x)
{
    uint a = floatBitsToUint(y), b = floatBitsToUint(x);
    bool equal = ((a ^ b) & ~SIGN_BIT) == 0u, zero = (a & ~SIGN_BIT) == 0u;
    float slope = zero ? 0.0 : equal ? 1.0 : portable_divide(portable_abs(y), portable_abs(x)); // 1 also for two infinities
    float angle = arc_tangent(slope);
    angle = b >= SIGN_BIT ? 2.0 * HALF_PI.x - (angle - 2.0 * HALF_PI.y) : angle;
    angle = a >= SIGN_BIT ? -angle : angle;
    return is_nan_bits(a) || is_nan_bits(b) ? portable_nan() : angle;
}

// (asin(r) - r) / r as a function of z = r^2, for r up to 0.5.
float arc_sine_part(const float z)
{
    return z * ((((((0.033800479 * z + 0.00827382505) * z + 0.0243319925) * z + 0.0301610455) * z +
                   0.0446555205) * z + 0.0749996826) * z + 0.166666672);
}

// 2.31 ulp; NaN outside -1..1, as for acos.
float portable_asin(const float x)
{
    float size = portable_abs(x);
    bool steep = size > 0.5;
    float z = steep ? 0.5 * (1.0 - size) : size * size;
    float r = steep ? portable_sqrt(z) : size;
    float angle = r + r * arc_sine_part(z);
    angle = steep ? HALF_PI.x - (2.0 * angle - HALF_PI.y) : angle;
    angle = floatBitsToUint(x) >= SIGN_BIT ? -angle : angle;
    return size <= 1.0 ? angle : portable_nan();
}

// 1.10 ulp.
float portable_acos(const float x)
{
    float size = abs(x);
    bool steep = size > 0.5;
    float z = steep ? 0.5 * (1.0 - size) : size * size;
    float r = steep ? portable_sqrt(z) : x;
    float part = r * arc_sine_part(z);
    float angle = !steep    ? HALF_PI.x - (r - (HALF_PI.y - part))
                  : x < 0.0 ? 2.0 * (HALF_PI.x - (r - (HALF_PI.y - part)))
                            : 2.0 * (r + part);
    return size <= 1.0 ? angle : portable_nan();
}

// ---- What is exact, but where GLSL leaves NaN, halves or the out-of-range to the driver ----

float portable_min(const float x, const float y)
{
    return portable_less(y, x) ? y : x;
}

float portable_max(const float x, const float y)
{
    return portable_less(x, y) ? y : x;
}

// A limit that is NaN is ignored; where low > high, the result is high.
float portable_clamp(const float x, const float low, const float high)
{
    return portable_min(portable_max(x, low), high);
}

float portable_sign(const float x) // 0 for NaN
{
    return portable_less(0.0, x) ? 1.0 : portable_less(x, 0.0) ? -1.0 : 0.0;
}

float portable_step(const float edge, const float x)
{
    return portable_less(x, edge) ? 0.0 : 1.0;
}

float portable_fract(const float x)
{
    return x - floor(x);
}

float portable_round(const float x) // halves to even
{
    return roundEven(x);
}

float portable_mod(const float x, const float y)
{
    return x - y * floor(portable_divide(x, y));
}

float portable_fma(const float x, const float y, const float z) // two roundings
{
    return x * y + z;
}

float portable_mix(const float x, const float y, const float a)
{
    return x * (1.0 - a) + y * a;
}

float portable_smoothstep(const float from, const float to, const float x)
{
    float t = portable_clamp(portable_divide(x - from, to - from), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

float portable_radians(const float x)
{
    return x * 0.0174532925;
}

float portable_degrees(const float x)
{
    return x * 57.2957795;
}

bool portable_isnan(const float x)
{
    return is_nan_bits(floatBitsToUint(x));
}

bool portable_isinf(const float x)
{
    return (floatBitsToUint(x) & ~SIGN_BIT) == INFINITE_BITS;
}

int portable_int(const float x) // out of range: the nearest int; 0 for NaN
{
    bool fits = abs(x) < 2147483648.0;
    int ends = x > 0.0 ? 0x7fffffff : x < 0.0 ? int(SIGN_BIT) : 0;
    return fits ? int(fits ? x : 0.0) : ends;
}

uint portable_uint(const float x) // likewise
{
    bool fits = x > -1.0 && x < 4294967296.0;
    return fits ? uint(fits ? x : 0.0) : x > 0.0 ? 0xffffffffu : 0u;
}

vec2 portable_unpackUnorm2x16(const uint bits)
{
    return vec2(portable_divide(float(bits & 0xffffu), 65535.0), portable_divide(float(bits >> 16), 65535.0));
}

vec4 portable_unpackUnorm4x8(const uint bits)
{
    vec4 parts = vec4(uvec4(bits, bits >> 8, bits >> 16, bits >> 24) & 0xffu);
    return vec4(portable_divide(parts.x, 255.0), portable_divide(parts.y, 255.0),
                portable_divide(parts.z, 255.0), portable_divide(parts.w, 255.0));
}

// ---- The same for each component of a vector ----

#define PORTABLE_EACH(T2, T3, T4, name)                                                            \
    T2 name(const vec2 x) { return T2(name(x.x), name(x.y)); }                                     \
    T3 name(const vec3 x) { return T3(name(x.x), name(x.y), name(x.z)); }                          \
    T4 name(const vec4 x) { return T4(name(x.x), name(x.y), name(x.z), name(x.w)); }
#define PORTABLE_UNARY(name) PORTABLE_EACH(vec2, vec3, vec4, name)
#define PORTABLE_PAIRS(T2, T3, T4, name)                                                           \
    T2 name(const vec2 x, const vec2 y) { return T2(name(x.x, y.x), name(x.y, y.y)); }             \
    T3 name(const vec3 x, const vec3 y)                                                            \
    {                                                                                              \
        return T3(name(x.x, y.x), name(x.y, y.y), name(x.z, y.z));                                 \
    }                                                                                              \
    T4 name(const vec4 x, const vec4 y)                                                            \
    {                                                                                              \
        return T4(name(x.x, y.x), name(x.y, y.y), name(x.z, y.z), name(x.w, y.w));                 \
    }
#define PORTABLE_BINARY(name)   PORTABLE_PAIRS(vec2, vec3, vec4, name)
#define PORTABLE_RELATION(name) PORTABLE_PAIRS(bvec2, bvec3, bvec4, name)
#define PORTABLE_TERNARY(name)                                                                     \
    vec2 name(const vec2 x, const vec2 y, const vec2 z)                                            \
    {                                                                                              \
        return vec2(name(x.x, y.x, z.x), name(x.y, y.y, z.y));                                     \
    }                                                                                              \
    vec3 name(const vec3 x, const vec3 y, const vec3 z)                                            \
    {                                                                                              \
        return vec3(name(x.x, y.x, z.x), name(x.y, y.y, z.y), name(x.z, y.z, z.z));                \
    }                                                                                              \
    vec4 name(const vec4 x, const vec4 y, const vec4 z)                                            \
    {                                                                                              \
        return vec4(name(x.x, y.x, z.x), name(x.y, y.y, z.y), name(x.z, y.z, z.z),                 \
                    name(x.w, y.w, z.w));                                                          \
    }

PORTABLE_RELATION(portable_less)
PORTABLE_RELATION(portable_at_most)
PORTABLE_RELATION(portable_equal)
PORTABLE_RELATION(portable_unequal)
PORTABLE_RELATION(portable_more)
PORTABLE_RELATION(portable_at_least)
PORTABLE_UNARY(portable_abs)
PORTABLE_BINARY(portable_step)
PORTABLE_BINARY(portable_divide)
PORTABLE_UNARY(portable_sqrt)
PORTABLE_UNARY(portable_inversesqrt)
PORTABLE_UNARY(portable_exp2)
PORTABLE_UNARY(portable_exp)
PORTABLE_UNARY(portable_log2)
PORTABLE_UNARY(portable_log)
PORTABLE_BINARY(portable_pow)
PORTABLE_UNARY(portable_sin)
PORTABLE_UNARY(portable_cos)
PORTABLE_UNARY(portable_tan)
PORTABLE_UNARY(portable_asin)
PORTABLE_UNARY(portable_acos)
PORTABLE_UNARY(portable_atan)
PORTABLE_BINARY(portable_atan)
PORTABLE_UNARY(portable_sign)
PORTABLE_UNARY(portable_round)
PORTABLE_BINARY(portable_mod)
PORTABLE_TERNARY(portable_smoothstep)
PORTABLE_EACH(bvec2, bvec3, bvec4, portable_isnan)
PORTABLE_EACH(bvec2, bvec3, bvec4, portable_isinf)
PORTABLE_EACH(ivec2, ivec3, ivec4, portable_int)
PORTABLE_EACH(uvec2, uvec3, uvec4, portable_uint)

// ---- Vectors: sums from the first component to the last ----

float portable_dot(const vec2 x, const vec2 y)
{
    return x.x * y.x + x.y * y.y;
}

float portable_dot(const vec3 x, const vec3 y)
{
    return (x.x * y.x + x.y * y.y) + x.z * y.z;
}

float portable_dot(const vec4 x, const vec4 y)
{
    return ((x.x * y.x + x.y * y.y) + x.z * y.z) + x.w * y.w;
}

float portable_dot(const float x, const float y) // for the macros below
{
    return x * y;
}

vec3 portable_cross(const vec3 x, const vec3 y)
{
    return x.yzx * y.zxy - y.yzx * x.zxy;
}

// In refract, k < 0 means total reflection. A length whose square underflows is 0; one whose square
// overflows is infinite.
#define PORTABLE_VECTOR(T)                                                                         \
    float portable_length(const T x) { return portable_sqrt(portable_dot(x, x)); }                 \
    float portable_distance(const T x, const T y) { return portable_length(x - y); }               \
    T portable_normalize(const T x) { return x * portable_inversesqrt(portable_dot(x, x)); }       \
    T portable_reflect(const T i, const T n) { return i - n * (2.0 * portable_dot(n, i)); }        \
    T portable_refract(const T i, const T n, const float eta)                                      \
    {                                                                                              \
        float along = portable_dot(n, i), k = 1.0 - eta * eta * (1.0 - along * along);             \
        T bent = eta * i - (eta * along + portable_sqrt(k)) * n;                                   \
        return k < 0.0 ? T(0.0) : bent;                                                            \
    }                                                                                              \
    T portable_faceforward(const T n, const T i, const T reference)                                \
    {                                                                                              \
        return portable_dot(reference, i) < 0.0 ? n : -n;                                          \
    }
PORTABLE_VECTOR(float)
PORTABLE_VECTOR(vec2)
PORTABLE_VECTOR(vec3)
PORTABLE_VECTOR(vec4)

// Written out for vectors, so that their comparisons are vector operations.
#define PORTABLE_WRITTEN(T)                                                                       \
    T portable_min(const T x, const T y)                                                           \
    {                                                                                              \
        return OWN_COMPARISON ? mix(x, y, lessThan(y, x)) : mix(x, y, portable_less(y, x));        \
    }                                                                                              \
    T portable_max(const T x, const T y)                                                           \
    {                                                                                              \
        return OWN_COMPARISON ? mix(x, y, lessThan(x, y)) : mix(x, y, portable_less(x, y));        \
    }                                                                                              \
    T portable_clamp(const T x, const T low, const T high)                                         \
    {                                                                                              \
        return portable_min(portable_max(x, low), high);                                           \
    }                                                                                              \
    T portable_fract(const T x) { return x - floor(x); }                                           \
    T portable_fma(const T x, const T y, const T z) { return x * y + z; }                          \
    T portable_mix(const T x, const T y, const T a) { return x * (T(1.0) - a) + y * a; }           \
    T portable_radians(const T x) { return x * 0.0174532925; }                                     \
    T portable_degrees(const T x) { return x * 57.2957795; }
PORTABLE_WRITTEN(vec2)
PORTABLE_WRITTEN(vec3)
PORTABLE_WRITTEN(vec4)

vec2 portable_times(const mat2 m, const vec2 v)
{
    return m[0] * v.x + m[1] * v.y;
}

vec3 portable_times(const mat3 m, const vec3 v)
{
    return (m[0] * v.x + m[1] * v.y) + m[2] * v.z;
}

vec4 portable_times(const mat4 m, const vec4 v)
{
    return ((m[0] * v.x + m[1] * v.y) + m[2] * v.z) + m[3] * v.w;
}

#define PORTABLE_MATRIX(M, V, ROW, COLUMNS)                                                        \
    V portable_times(const V v, const M m) { return ROW; }                                         \
    M portable_times(const M m, const M n) { return COLUMNS; }
PORTABLE_MATRIX(mat2, vec2, vec2(portable_dot(v, m[0]), portable_dot(v, m[1])),
                mat2(portable_times(m, n[0]), portable_times(m, n[1])))
PORTABLE_MATRIX(mat3, vec3,
                vec3(portable_dot(v, m[0]), portable_dot(v, m[1]), portable_dot(v, m[2])),
                mat3(portable_times(m, n[0]), portable_times(m, n[1]), portable_times(m, n[2])))
PORTABLE_MATRIX(mat4, vec4,
                vec4(portable_dot(v, m[0]), portable_dot(v, m[1]), portable_dot(v, m[2]),
                     portable_dot(v, m[3])),
                mat4(portable_times(m, n[0]), portable_times(m, n[1]), portable_times(m, n[2]),
                     portable_times(m, n[3])))

#endif

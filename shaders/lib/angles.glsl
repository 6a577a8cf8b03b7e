// Trigonometry by operations with one rounding each: GLSL's own functions have the errors and the
// bits that the driver chooses (atan() may be off by 4096 ulp).
#ifndef LIB_ANGLES_GLSL
#define LIB_ANGLES_GLSL

// sine_cosine_pi of picture/camera.c is this in C, bit for bit. x: sin(pi a), y: cos(pi a), for a
// in -1..1. Within 1.2e-7 of the exact values: the nearest quarter turn is taken off, which is
// exact, and what remains, up to pi / 4, goes through the Taylor polynomials of degree 9 and 10,
// whose own error is below 2e-9.
vec2 sine_cosine_pi(float a)
{
    float size = abs(a);
    uint quarters = size > 0.75 ? 2u : size > 0.25 ? 1u : 0u;
    precise float rest = size - 0.5 * float(quarters);
    precise float r2 = rest * rest;
    precise float s = ((((0.0821458866 * r2 - 0.599264529) * r2 + 2.55016404) * r2 - 5.16771278) *
                       r2 + 3.14159265) * rest;
    precise float c = ((((-0.0258068913 * r2 + 0.235330630) * r2 - 1.33526277) * r2 + 4.05871213) *
                       r2 - 4.93480220) * r2 + 1.0;
    vec2 turned = quarters == 0u ? vec2(s, c) : quarters == 1u ? vec2(c, -s) : vec2(-s, -c);
    return vec2(a < 0.0 ? -turned.x : turned.x, turned.y);
}

// 1 / sqrt(x) within 2 ulp, by products and differences alone, so that no driver changes its bits.
// Newton's steps from a guess by the exponent (Lomont 2003, "Fast inverse square root").
// inverse_square_root of picture/camera.c is this in C, bit for bit.
float inverse_square_root(float x)
{
    precise float y = uintBitsToFloat(0x5f375a86u - (floatBitsToUint(x) >> 1));
    precise float half_x = 0.5 * x;
    y = y * (1.5 - (half_x * y) * y);
    y = y * (1.5 - (half_x * y) * y);
    y = y * (1.5 - (half_x * y) * y);
    y = y * (1.5 - (half_x * y) * y);
    return y;
}

// Angle of (x, y) from the x axis, -pi..pi; 0 for (0, 0). The polynomial is off by at most 2e-8
// (Abramowitz and Stegun 1964, 4.4.49).
float angle_of(float x, float y)
{
    const float pi = 3.14159265;
    float ax = abs(x), ay = abs(y);
    float large = max(ax, ay), small = min(ax, ay);
    float r = large > 0.0 ? small / large : 0.0;
    float q = r * r;
    float p = -0.0161657367 + q * 0.0028662257;
    p = 0.0429096138 + q * p;
    p = -0.0752896400 + q * p;
    p = 0.1065626393 + q * p;
    p = -0.1420889944 + q * p;
    p = 0.1999355085 + q * p;
    p = -0.3333314528 + q * p;
    float angle = r + r * q * p;
    angle = ay > ax ? 0.5 * pi - angle : angle;
    angle = x < 0.0 ? pi - angle : angle;
    return y < 0.0 ? -angle : angle;
}

#endif

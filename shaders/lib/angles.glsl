// Sine and cosine by products and sums alone, each rounded once: GLSL's own have the error and the
// bits that a driver likes. sine_cosine_pi of render/camera.c is this in C, bit for bit.
#ifndef LIB_ANGLES_GLSL
#define LIB_ANGLES_GLSL

// x: sin(pi a), y: cos(pi a), for a in -1..1. Within 1.2e-7 of the exact values: the nearest quarter
// turn is taken off, which is exact, and what remains, up to pi / 4, goes through the Taylor
// polynomials of degree 9 and 10, whose own error is below 2e-9.
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

#endif

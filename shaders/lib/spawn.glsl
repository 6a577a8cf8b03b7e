// The start of a secondary ray: the hit point, moved off the surface by no more than its own error.
#ifndef LIB_SPAWN_GLSL
#define LIB_SPAWN_GLSL

// A ray starts at least this share of the largest coordinate of its origin away from each plane
// through 0. The share is at most 2^-24 of the distance between neighbouring floats there.
const float SPAWN_LEAST = 1.0 / 281474976710656.0; // 2^-48

// Bound of n roundings (Higham 2002, section 3.1), for 24-bit significands.
float rounding_bound(float n)
{
    const float unit = 1.0 / 16777216.0;
    return n * unit / (1.0 - n * unit);
}

// The next float up or down; or, where x is nearer to 0 than `least`, `least` in that direction. A
// plane through 0 has no error, and the next float from 0 is the least denormal, of which Intel's
// x86 processors take some 150 cycles for each product.
float next_float(float x, bool up, float least)
{
    uint bits = floatBitsToUint(x);
    bits = (x > 0.0) == up ? bits + 1u : bits - 1u;
    return abs(x) < least ? (up ? least : -least) : uintBitsToFloat(bits);
}

// Offsets `p` along `side`, the unit geometric normal on the side where the ray starts (Pharr,
// Jakob and Humphreys 2023, section 6.8.6). `error`: bound of the absolute error of `p`, per
// coordinate.
vec3 offset_origin(vec3 p, vec3 error, vec3 side)
{
    float distance = dot(abs(side), error);
    vec3 moved = p + side * distance, size = abs(moved);
    float least = max(max(size.x, max(size.y, size.z)) * SPAWN_LEAST, uintBitsToFloat(1u));
    moved.x = side.x != 0.0 ? next_float(moved.x, side.x > 0.0, least) : moved.x;
    moved.y = side.y != 0.0 ? next_float(moved.y, side.y > 0.0, least) : moved.y;
    moved.z = side.z != 0.0 ? next_float(moved.z, side.z > 0.0, least) : moved.z;
    return moved;
}

#endif

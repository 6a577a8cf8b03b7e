// Where a secondary ray starts: the hit point moved off the surface by no more than its own error.
#ifndef LIB_SPAWN_GLSL
#define LIB_SPAWN_GLSL

// Bound of n roundings (Higham 2002, section 3.1), for 24-bit significands.
float rounding_bound(float n)
{
    const float unit = 1.0 / 16777216.0;
    return n * unit / (1.0 - n * unit);
}

// One float further from 0, or towards it.
float next_float(float x, bool up)
{
    if (x == 0.0)
        return up ? uintBitsToFloat(1u) : uintBitsToFloat(0x80000001u);
    uint bits = floatBitsToUint(x);
    bits = (x > 0.0) == up ? bits + 1u : bits - 1u;
    return uintBitsToFloat(bits);
}

// Offset along `side`, the unit geometric normal on the side the ray leaves to (Pharr, Jakob and
// Humphreys 2023, section 6.8.6). `error`: bound of the absolute error of `p`, per coordinate.
vec3 offset_origin(vec3 p, vec3 error, vec3 side)
{
    float distance = dot(abs(side), error);
    vec3 moved = p + side * distance;
    moved.x = side.x != 0.0 ? next_float(moved.x, side.x > 0.0) : moved.x;
    moved.y = side.y != 0.0 ? next_float(moved.y, side.y > 0.0) : moved.y;
    moved.z = side.z != 0.0 ? next_float(moved.z, side.z > 0.0) : moved.z;
    return moved;
}

#endif

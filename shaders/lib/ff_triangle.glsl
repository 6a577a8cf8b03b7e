// The test of exact.glsl in float-float arithmetic: nearly always enough, for a
// small part of the cost of integers. twin/ff_triangle.c is this file in C.
#ifndef LIB_FF_TRIANGLE_GLSL
#define LIB_FF_TRIANGLE_GLSL

#include "ff_numbers.glsl"

// d.(a x b) for vectors up to length 2, with a bound of its error: from the sizes of its terms,
// with room for five times what the operations add up to, and from underflow, see ff_meet.
vec2 ff_triple(PairVector d, PairVector a, PairVector b, out float error)
{
    vec3 ma = magnitudes(a), mb = magnitudes(b), md = magnitudes(d);
    precise vec3 terms = ma.yzx * mb.zxy + ma.zxy * mb.yzx;
    precise float size = (md.x * terms.x + md.y * terms.y) + md.z * terms.z;
    precise float most = size * FF_RELATIVE + FF_ABSOLUTE;
    error = most;
    return ff_dot(d, ff_cross(a, b));
}

// Vectors from a ray's origin to a triangle's vertices and between these, and the direction; each
// scaled to lengths up to 2, by these powers of two.
//
// Differences of vertices are exact but for underflow, below 2^-126; so where the largest is 2^-40
// or more, they are good to 2^-86 of it.
struct PairTriangle {
    PairVector a, b, ab, ac, bc, along;
    int way, size, speed;
    bool fit; // they can be scaled
};

PairTriangle ff_triangle(vec3 origin, vec3 dir, vec3 v0, vec3 v1, vec3 v2)
{
    PairTriangle p;
    p.a = ff_difference(v0, origin);
    p.b = ff_difference(v1, origin);
    p.ab = ff_difference(v1, v0);
    p.ac = ff_difference(v2, v0);
    p.bc = ff_difference(v2, v1);
    p.along = PairVector(vec2(dir.x, 0.0), vec2(dir.y, 0.0), vec2(dir.z, 0.0));
    float way = larger(largest_magnitude(magnitudes(p.a)), largest_magnitude(magnitudes(p.b)));
    float size = larger(largest_magnitude(magnitudes(p.ab)), largest_magnitude(magnitudes(p.ac)));
    size = larger(size, largest_magnitude(magnitudes(p.bc)));
    float speed = largest_magnitude(dir);
    p.fit = is_fit(way) && is_fit(size) && is_fit(speed);
    p.way = length_exponent(way);
    p.size = length_exponent(size);
    p.speed = length_exponent(speed);
    p.a = ff_scaled(p.a, power_of_two(-p.way));
    p.b = ff_scaled(p.b, power_of_two(-p.way));
    p.ab = ff_scaled(p.ab, power_of_two(-p.size));
    p.ac = ff_scaled(p.ac, power_of_two(-p.size));
    p.bc = ff_scaled(p.bc, power_of_two(-p.size));
    p.along = ff_scaled(p.along, power_of_two(-p.speed));
    return p;
}

// d.(b x c) and so on, computed from the triangle's edges, which cancels less; and t as a ratio.
// `off`, `top_off`, `bottom_off`: error bounds.
struct PairEdges {
    vec3 edges, off;
    vec2 top, bottom;
    float top_off, bottom_off;
};

PairEdges ff_edges(PairTriangle p)
{
    PairEdges e;
    for (int n = 0; n < 5; n++) { // a loop, so that there is less code to compile
        PairVector x = n == 0 ? p.b : n == 1 ? p.ac : n == 2 ? p.a : p.ab;
        PairVector y = n == 0 ? p.bc : n == 1 ? p.a : n == 2 ? p.ab : p.ac;
        float error;
        vec2 value = ff_triple(n == 3 ? p.a : p.along, x, y, error);
        e.edges = vec3(n == 0 ? value.x : e.edges.x, n == 1 ? value.x : e.edges.y,
                       n == 2 ? value.x : e.edges.z);
        e.off = vec3(n == 0 ? error : e.off.x, n == 1 ? error : e.off.y, n == 2 ? error : e.off.z);
        e.top = n == 3 ? value : e.top;
        e.top_off = n == 3 ? error : e.top_off;
        e.bottom = value;
        e.bottom_off = error;
    }
    return e;
}

// The result of exact_meet(). False: float-float arithmetic does not decide it. `key_known`: m.key is the
// key if the triangle is met.
bool ff_meet(vec3 origin, vec3 dir, vec3 v0, vec3 v1, vec3 v2, out ExactCandidate m,
               out bool key_known)
{
    PairTriangle p = ff_triangle(origin, dir, v0, v1, v2);
    PairEdges e = ff_edges(p);
    bvec3 below = lessThan(e.edges, -e.off), above = greaterThan(e.edges, e.off);
    bool sided = p.fit && abs(e.bottom.x) > e.bottom_off;
    bool outside = p.fit && any(below) && any(above);
    bool inside = sided && (all(below) || all(above));
    bool behind =
        sided && abs(e.top.x) > e.top_off && (e.top.x < 0.0) != (e.bottom.x < 0.0);
    bool point = v0 == v1 || v1 == v2 || v2 == v0; // the triangle has no area
    float t, to_weight = power_of_two(p.way - p.size);
    key_known = round_ratio(e.top, e.bottom, e.top_off, e.bottom_off, t) && p.fit;
    precise float key = t * power_of_two(p.way - p.speed);
    precise float u = e.edges.y / e.bottom.x * to_weight;
    precise float v = e.edges.z / e.bottom.x * to_weight;
    m.key = key;
    m.u = u;
    m.v = v;
    m.front = e.bottom.x < 0.0;
    m.on_edge = bvec3(false);
    m.met = inside && key_known && !point;
    return outside || behind || point || m.met;
}

#endif

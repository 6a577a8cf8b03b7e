// What exact.glsl's integers tell, in pairs of floats: nearly always enough, for a small part of their
// price. accel/pairs.c is this file in C.
#ifndef LIB_PAIRS_GLSL
#define LIB_PAIRS_GLSL

#include "pair_numbers.glsl"

PairVector pair_cross(PairVector a, PairVector b)
{
    PairVector n;
    n.x = pair_plus(pair_times(a.y, b.z), -pair_times(a.z, b.y));
    n.y = pair_plus(pair_times(a.z, b.x), -pair_times(a.x, b.z));
    n.z = pair_plus(pair_times(a.x, b.y), -pair_times(a.y, b.x));
    return n;
}

// d.(a x b) of vectors up to 2, and in `error` how far it may be off: by the sizes of what it is the sum
// of, with room for five times what the operations add up to; and by what underflows, see pair_meet.
vec2 pair_triple(PairVector d, PairVector a, PairVector b, out float error)
{
    vec3 ma = magnitudes(a), mb = magnitudes(b), md = magnitudes(d);
    precise vec3 terms = ma.yzx * mb.zxy + ma.zxy * mb.yzx;
    precise float size = (md.x * terms.x + md.y * terms.y) + md.z * terms.z;
    precise float most = size * PAIR_RELATIVE + PAIR_ABSOLUTE;
    error = most;
    return pair_dot(d, pair_cross(a, b));
}

// What exact_meet() says, if it is sure. `key_known`: if the triangle is met, m.key is the key.
//
// Differences of vertices are exact but for what underflows, below 2^-126; so at 2^-40 and more they
// are, relative to the largest, good to 2^-86.
bool pair_meet(vec3 origin, vec3 dir, vec3 v0, vec3 v1, vec3 v2, out ExactMeeting m,
               out bool key_known)
{
    PairVector a = pair_difference(v0, origin), b = pair_difference(v1, origin);
    PairVector ab = pair_difference(v1, v0), ac = pair_difference(v2, v0);
    PairVector bc = pair_difference(v2, v1);
    PairVector along = PairVector(vec2(dir.x, 0.0), vec2(dir.y, 0.0), vec2(dir.z, 0.0));
    float way = larger(largest_magnitude(magnitudes(a)), largest_magnitude(magnitudes(b)));
    float size = larger(larger(largest_magnitude(magnitudes(ab)),
                               largest_magnitude(magnitudes(ac))),
                        largest_magnitude(magnitudes(bc)));
    float speed = largest_magnitude(dir);
    int way_exponent = length_exponent(way), size_exponent = length_exponent(size);
    int speed_exponent = length_exponent(speed);
    a = pair_scaled(a, power_of_two(-way_exponent));
    b = pair_scaled(b, power_of_two(-way_exponent));
    ab = pair_scaled(ab, power_of_two(-size_exponent));
    ac = pair_scaled(ac, power_of_two(-size_exponent));
    bc = pair_scaled(bc, power_of_two(-size_exponent));
    along = pair_scaled(along, power_of_two(-speed_exponent));
    // d.(b x c) and so on, by the edges: less cancels out. A loop, for less code to compile.
    vec3 edges, off;
    vec2 top, bottom;
    float top_off, bottom_off, t;
    for (int n = 0; n < 5; n++) {
        PairVector x = n == 0 ? b : n == 1 ? ac : n == 2 ? a : ab;
        PairVector y = n == 0 ? bc : n == 1 ? a : n == 2 ? ab : ac;
        float error;
        vec2 value = pair_triple(n == 3 ? a : along, x, y, error);
        edges = vec3(n == 0 ? value.x : edges.x, n == 1 ? value.x : edges.y,
                     n == 2 ? value.x : edges.z);
        off = vec3(n == 0 ? error : off.x, n == 1 ? error : off.y, n == 2 ? error : off.z);
        top = n == 3 ? value : top;
        top_off = n == 3 ? error : top_off;
        bottom = value;
        bottom_off = error;
    }
    bool fit = is_fit(way) && is_fit(size) && is_fit(speed);
    bvec3 below = lessThan(edges, -off), above = greaterThan(edges, off);
    bool sided = fit && abs(bottom.x) > bottom_off;
    bool outside = fit && any(below) && any(above);
    bool inside = sided && (all(below) || all(above));
    bool behind = sided && abs(top.x) > top_off && (top.x < 0.0) != (bottom.x < 0.0);
    bool point = v0 == v1 || v1 == v2 || v2 == v0; // no area
    key_known = round_ratio(top, bottom, top_off, bottom_off, t) && fit;
    precise float key = t * power_of_two(way_exponent - speed_exponent);
    float to_weight = power_of_two(way_exponent - size_exponent);
    precise float u = edges.y / bottom.x * to_weight;
    precise float v = edges.z / bottom.x * to_weight;
    m.key = key;
    m.u = u;
    m.v = v;
    m.front = bottom.x < 0.0;
    m.on_edge = bvec3(false);
    m.met = inside && key_known && !point;
    return outside || behind || point || m.met;
}

#endif

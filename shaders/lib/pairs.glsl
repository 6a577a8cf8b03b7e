// What exact.glsl's integers tell, in pairs of floats: nearly always enough, for a small part of their
// price. A pair is its sum, the second float being a rounding error of the first (Dekker 1971, "A
// floating-point technique for extending the available precision"). Products of pairs are off by 2^-43
// of themselves, sums by 2^-46 of their terms. accel/pairs.c is this file in C.
#ifndef LIB_PAIRS_GLSL
#define LIB_PAIRS_GLSL

#include "exact.glsl"

const float PAIR_RELATIVE = 1.0 / 2199023255552.0; // 2^-41
const float PAIR_ABSOLUTE = 1.0 / 1208925819614629174706176.0; // 2^-80
const float PAIR_LEAST = 1.0 / 1099511627776.0; // 2^-40

vec2 pair_sum(float a, float b) // exact (Knuth's two-sum)
{
    precise float s = a + b;
    precise float from_b = s - a;
    precise float error = (a - (s - from_b)) + (b - from_b);
    return vec2(s, error);
}

vec2 pair_split(float a)
{
    precise float c = 4097.0 * a;
    precise float high = c - (c - a);
    precise float low = a - high;
    return vec2(high, low);
}

vec2 pair_product(float a, float b) // exact, but for underflow
{
    vec2 as = pair_split(a), bs = pair_split(b);
    precise float p = a * b;
    precise float error = ((as.x * bs.x - p) + as.x * bs.y + as.y * bs.x) + as.y * bs.y;
    return vec2(p, error);
}

vec2 pair_times(vec2 a, vec2 b)
{
    vec2 p = pair_product(a.x, b.x);
    precise float low = p.y + (a.x * b.y + a.y * b.x);
    return pair_sum(p.x, low);
}

vec2 pair_plus(vec2 a, vec2 b)
{
    vec2 s = pair_sum(a.x, b.x);
    precise float low = s.y + (a.y + b.y);
    return pair_sum(s.x, low);
}

struct PairVector {
    vec2 x, y, z;
};

PairVector pair_difference(vec3 a, vec3 b) // exact
{
    return PairVector(pair_sum(a.x, -b.x), pair_sum(a.y, -b.y), pair_sum(a.z, -b.z));
}

vec3 magnitudes(PairVector v)
{
    return abs(vec3(v.x.x, v.y.x, v.z.x));
}

PairVector pair_cross(PairVector a, PairVector b)
{
    PairVector n;
    n.x = pair_plus(pair_times(a.y, b.z), -pair_times(a.z, b.y));
    n.y = pair_plus(pair_times(a.z, b.x), -pair_times(a.x, b.z));
    n.z = pair_plus(pair_times(a.x, b.y), -pair_times(a.y, b.x));
    return n;
}

vec2 pair_dot(PairVector a, PairVector b)
{
    return pair_plus(pair_plus(pair_times(a.x, b.x), pair_times(a.y, b.y)),
                     pair_times(a.z, b.z));
}

// The power of two that takes a finite length to 1..2, but for the very large and the very small.
int length_exponent(float largest)
{
    return clamp(int(floatBitsToUint(largest) >> 23 & 255u) - 127, -100, 100);
}

float power_of_two(int exponent) // -126..127
{
    return uintBitsToFloat(uint(exponent + 127) << 23);
}

PairVector pair_scaled(PairVector v, float power)
{
    return PairVector(v.x * power, v.y * power, v.z * power);
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

// t = top / bottom, rounded to nearest. False: not sure. The quotient need not be rounded rightly: what
// it leaves is divided once more.
bool round_ratio(vec2 top, vec2 bottom, float top_error, float bottom_error, out float t)
{
    precise float first = top.x / bottom.x;
    vec2 back = pair_product(first, bottom.x);
    precise float rest = ((top.x - back.x) - back.y) + (top.y - first * bottom.y);
    precise float second = rest / bottom.x;
    vec2 both = pair_sum(first, second);
    precise float error = top_error / abs(bottom.x) +
                          abs(both.x) * (bottom_error / abs(bottom.x) + PAIR_RELATIVE);
    uint bits = floatBitsToUint(both.x);
    float next = uintBitsToFloat(both.y > 0.0 ? bits + 1u : bits - 1u); // t > 0
    precise float to_middle = 0.5 * abs(next - both.x);
    precise float off = abs(both.y) + error;
    t = both.x;
    return t > PAIR_LEAST && abs(bottom.x) > PAIR_LEAST && off < to_middle;
}

bool is_fit(float largest)
{
    return largest > 1.0 / 1099511627776.0 && largest < 1099511627776.0; // 2^-40, 2^40
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

// The test of exact_sphere.glsl in float-float arithmetic: nearly always enough,
// for a small part of the cost of integers. twin/ff_sphere.c is this file in C.
#ifndef LIB_FF_SPHERE_GLSL
#define LIB_FF_SPHERE_GLSL

#include "exact_sphere.glsl"
#include "ff_numbers.glsl"

// A float-float number, and how far it may be off.
struct BoundedPair {
    vec2 value;
    float error;
};

BoundedPair bounded_ff(vec2 value, float size)
{
    precise float error = size * FF_RELATIVE + FF_ABSOLUTE;
    return BoundedPair(value, error);
}

// The coefficients of P t^2 - 2 S t + Q, whose roots are the t of the ends. In units in which the
// largest component of the direction is 1 to 2, and so is the larger of the radius and the largest
// component of the vector to the centre.
struct Quadratic {
    BoundedPair p, s, q;
};

Quadratic find_quadratic(PairVector m, PairVector d, vec2 rr)
{
    vec3 sm = magnitudes(m), sd = magnitudes(d);
    vec2 mm = ff_dot(m, m), p = ff_dot(d, d);
    precise float ms = (sm.x * sd.x + sm.y * sd.y) + sm.z * sd.z;
    precise float qs = mm.x + rr.x;
    return Quadratic(bounded_ff(p, p.x), bounded_ff(ff_dot(m, d), ms),
                     bounded_ff(ff_plus(mm, -rr), qs));
}

// The discriminant, S^2 - P Q = r^2 P - |m x d|^2 (Lagrange): the size of its terms is that of the
// sphere, however far away it is.
BoundedPair discriminant(PairVector m, PairVector d, vec2 rr, BoundedPair p)
{
    vec3 sm = magnitudes(m), sd = magnitudes(d);
    PairVector x = ff_cross(m, d);
    vec3 sx = magnitudes(x);
    precise vec3 e = (sm.yzx * sd.zxy + sm.zxy * sd.yzx) * FF_RELATIVE + FF_ABSOLUTE;
    precise vec3 each = (2.0 * sx + e) * e;
    precise float of_x = (each.x + each.y) + each.z;
    vec2 rp = ff_times(rr, p.value), xx = ff_dot(x, x);
    precise float size = rp.x + xx.x;
    BoundedPair room = bounded_ff(ff_plus(rp, -xx), size);
    precise float error = room.error + (of_x + rr.x * p.error) * 1.0625;
    room.error = error;
    return room;
}

// The square root of a number that is larger than its error. The first float is off by at most 4.5
// units in the last place; the second is computed from what remains, and leaves a relative error of
// 2^-41.
BoundedPair root_of(BoundedPair x)
{
    precise float first = sqrt(x.value.x);
    vec2 square = ff_product(first, first);
    precise float rest = ((x.value.x - square.x) - square.y) + x.value.y;
    precise float second = rest / (2.0 * first);
    precise float error = x.error / first + first * (2.0 * FF_RELATIVE);
    return BoundedPair(ff_sum(first, second), error);
}

int sign_known(BoundedPair x)
{
    return x.value.x > x.error ? 1 : x.value.x < -x.error ? -1 : 0;
}

// The result of exact_meet_sphere(). False: float-float arithmetic does not decide it.
bool ff_meet_sphere(vec3 origin, vec3 dir, vec3 center, float radius, bool only_far, float t_min,
                      out SphereCandidate candidate)
{
    PairVector m = ff_difference(center, origin);
    PairVector d = PairVector(vec2(dir.x, 0.0), vec2(dir.y, 0.0), vec2(dir.z, 0.0));
    float way = larger(largest_magnitude(magnitudes(m)), radius), speed = largest_magnitude(dir);
    int way_exponent = length_exponent(way), speed_exponent = length_exponent(speed);
    m = ff_scaled(m, power_of_two(-way_exponent));
    d = ff_scaled(d, power_of_two(-speed_exponent));
    float scaled = radius * power_of_two(-way_exponent);
    vec2 rr = ff_product(scaled, scaled);
    Quadratic f = find_quadratic(m, d, rr);
    BoundedPair room = discriminant(m, d, rr, f.p);
    int side = sign_known(room), s = sign_known(f.s), q = sign_known(f.q);
    // |S| + root has no cancellation; the other end comes from Q over it.
    BoundedPair root = root_of(room);
    vec2 sum = ff_plus(s < 0 ? -f.s.value : f.s.value, root.value);
    vec2 past = s < 0 ? -f.q.value : f.q.value;
    precise float sum_error = (f.s.error + root.error) + sum.x * FF_RELATIVE;
    float to_t = power_of_two(way_exponent - speed_exponent), near, far;
    bool near_known, far_known;
    for (int end = 0; end < 2; end++) {
        bool over_p = end == 1 && s > 0;
        float t;
        bool known = round_ratio(over_p ? sum : past, over_p ? f.p.value : sum,
                                 over_p ? sum_error : f.q.error, over_p ? f.p.error : sum_error, t);
        precise float key = t * to_t;
        near = end == 0 ? key : near;
        near_known = end == 0 ? known : near_known;
        far = key;
        far_known = known;
    }
    bool near_some = s > 0 && q > 0 && near_known, near_none = s < 0 || q < 0;
    bool far_some = (s > 0 || (s < 0 && q < 0)) && far_known, far_none = s < 0 && q > 0;
    bool at_exit = only_far || !(near_some && near >= t_min);
    candidate.at_exit = at_exit;
    candidate.inward = s > 0;
    candidate.key = at_exit ? far : near;
    candidate.met = side > 0 && (at_exit ? far_some && far >= t_min : near_some);
    bool end_known = at_exit ? (only_far || near_some || near_none) && (far_some || far_none)
                             : near_some;
    return is_fit(way) && is_fit(speed) && (side < 0 || (side > 0 && end_known));
}

#endif

#include "twin/ff_sphere.h"

#include "twin/ff_numbers.h"

/* The coefficients of f(t) = P t^2 - 2 S t + Q, whose roots are the t of the chord's ends; in units
   in which the direction, and the larger of the radius and the vector to the centre, are 1 to 2
   long. */
struct quadratic {
    struct bounded_ff p, s, q;
};

static struct bounded_ff bounded(struct ff value, float size)
{
    return (struct bounded_ff){value, size * FF_RELATIVE + FF_ABSOLUTE};
}

static struct quadratic find_quadratic(const struct ff_vector *m, const struct ff_vector *d,
                                       struct ff rr)
{
    struct vec3 sm = ff_magnitudes(m), sd = ff_magnitudes(d);
    struct ff mm = ff_dot(m, m), p = ff_dot(d, d);
    float ms = (sm.x * sd.x + sm.y * sd.y) + sm.z * sd.z;
    return (struct quadratic){.p = bounded(p, p.high),
                              .s = bounded(ff_dot(m, d), ms),
                              .q = bounded(ff_minus(mm, rr), mm.high + rr.high)};
}

/* The discriminant, S^2 - P Q = r^2 P - |m x d|^2 (Lagrange): the size of its terms is that of the
   sphere, however far away it is. */
static struct bounded_ff discriminant(const struct ff_vector *m, const struct ff_vector *d,
                                      struct ff rr, struct bounded_ff p)
{
    struct vec3 sm = ff_magnitudes(m), sd = ff_magnitudes(d);
    struct ff_vector x = ff_cross(m, d);
    struct vec3 sx = ff_magnitudes(&x);
    float ex = (sm.y * sd.z + sm.z * sd.y) * FF_RELATIVE + FF_ABSOLUTE;
    float ey = (sm.z * sd.x + sm.x * sd.z) * FF_RELATIVE + FF_ABSOLUTE;
    float ez = (sm.x * sd.y + sm.y * sd.x) * FF_RELATIVE + FF_ABSOLUTE;
    float of_x = ((2.0f * sx.x + ex) * ex + (2.0f * sx.y + ey) * ey) + (2.0f * sx.z + ez) * ez;
    struct ff rp = ff_times(rr, p.value), xx = ff_dot(&x, &x);
    struct bounded_ff room = bounded(ff_minus(rp, xx), rp.high + xx.high);
    room.error = room.error + (of_x + rr.high * p.error) * 1.0625f;
    return room;
}

/* The square root of a value that is larger than its own error bound. */
static struct bounded_ff root_of(struct bounded_ff x)
{
    float first = sqrtf(x.value.high);
    struct ff square = ff_product(first, first);
    float rest = ((x.value.high - square.high) - square.low) + x.value.low;
    return (struct bounded_ff){ff_sum(first, rest / (2.0f * first)),
                               x.error / first + first * (2.0f * FF_RELATIVE)};
}

static struct bounded_ff negated(struct bounded_ff x, bool flip)
{
    if (flip)
        x.value = (struct ff){-x.value.high, -x.value.low};
    return x;
}

static int sign_known(struct bounded_ff x)
{
    return x.value.high > x.error ? 1 : x.value.high < -x.error ? -1 : 0;
}

bool ff_meet_sphere(struct vec3 origin, struct vec3 dir, struct vec3 center, float radius,
                    bool only_far, float t_min, struct sphere_candidate *out)
{
    struct ff_vector m = ff_difference(center, origin);
    struct ff_vector d = {{dir.x, 0.0f}, {dir.y, 0.0f}, {dir.z, 0.0f}};
    float way = float_larger(ff_largest(&m), radius), speed = vec3_largest_magnitude(dir);
    int way_exponent = length_exponent(way), speed_exponent = length_exponent(speed);
    ff_scale(&m, power_of_two(-way_exponent));
    ff_scale(&d, power_of_two(-speed_exponent));
    float scaled = radius * power_of_two(-way_exponent);
    struct ff rr = ff_product(scaled, scaled);
    struct quadratic f = find_quadratic(&m, &d, rr);
    struct bounded_ff room = discriminant(&m, &d, rr, f.p);
    int side = sign_known(room), s = sign_known(f.s), q = sign_known(f.q);
    /* |S| + root has no cancellation; the other end comes from Q over it. */
    struct bounded_ff root = root_of(room), sum = negated(f.s, s < 0);
    sum.value = ff_plus(sum.value, root.value);
    sum.error = (sum.error + root.error) + sum.value.high * FF_RELATIVE;
    float key[2], to_t = power_of_two(way_exponent - speed_exponent);
    bool key_known[2];
    for (int end = 0; end < 2; ++end) {
        bool over_p = end == 1 && s > 0;
        key_known[end] =
            round_ratio(over_p ? sum : negated(f.q, s < 0), over_p ? f.p : sum, &key[end]);
        key[end] = key[end] * to_t;
    }
    bool near_some = s > 0 && q > 0 && key_known[0], near_none = s < 0 || q < 0;
    bool far_some = (s > 0 || (s < 0 && q < 0)) && key_known[1], far_none = s < 0 && q > 0;
    out->at_exit = only_far || !(near_some && key[0] >= t_min);
    out->inward = s > 0;
    out->key = key[out->at_exit ? 1 : 0];
    out->met = side > 0 && (out->at_exit ? far_some && out->key >= t_min : near_some);
    bool end_known =
        out->at_exit ? (only_far || near_some || near_none) && (far_some || far_none) : near_some;
    return is_fit(way) && is_fit(speed) && (side < 0 || (side > 0 && end_known));
}

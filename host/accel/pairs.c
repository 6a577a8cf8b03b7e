#include "accel/pairs.h"

#include "accel/pair_numbers.h"

static struct pair_vector cross(const struct pair_vector *a, const struct pair_vector *b)
{
    return (struct pair_vector){pair_minus(pair_times(a->y, b->z), pair_times(a->z, b->y)),
                                pair_minus(pair_times(a->z, b->x), pair_times(a->x, b->z)),
                                pair_minus(pair_times(a->x, b->y), pair_times(a->y, b->x))};
}

/* d.(a x b) of vectors up to 2. */
static struct bounded_pair triple(const struct pair_vector *d, const struct pair_vector *a,
                                  const struct pair_vector *b)
{
    struct vec3 ma = pair_magnitudes(a), mb = pair_magnitudes(b), md = pair_magnitudes(d);
    float x = ma.y * mb.z + ma.z * mb.y;
    float y = ma.z * mb.x + ma.x * mb.z;
    float z = ma.x * mb.y + ma.y * mb.x;
    float size = (md.x * x + md.y * y) + md.z * z;
    struct pair_vector normal = cross(a, b);
    return (struct bounded_pair){pair_dot(d, &normal), size * PAIR_RELATIVE + PAIR_ABSOLUTE};
}

static bool same(struct vec3 a, struct vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

bool pair_meet(struct vec3 origin, struct vec3 dir, struct vec3 v0, struct vec3 v1, struct vec3 v2,
               struct exact_meeting *out, bool *key_known)
{
    struct pair_vector a = pair_difference(v0, origin), b = pair_difference(v1, origin);
    struct pair_vector ab = pair_difference(v1, v0), ac = pair_difference(v2, v0),
                       bc = pair_difference(v2, v1);
    struct pair_vector along = {{dir.x, 0.0f}, {dir.y, 0.0f}, {dir.z, 0.0f}};
    float way = float_larger(pair_largest(&a), pair_largest(&b));
    float size =
        float_larger(float_larger(pair_largest(&ab), pair_largest(&ac)), pair_largest(&bc));
    float speed = vec3_largest_magnitude(dir);
    int way_exponent = length_exponent(way), size_exponent = length_exponent(size);
    int speed_exponent = length_exponent(speed);
    pair_scale(&a, power_of_two(-way_exponent));
    pair_scale(&b, power_of_two(-way_exponent));
    pair_scale(&ab, power_of_two(-size_exponent));
    pair_scale(&ac, power_of_two(-size_exponent));
    pair_scale(&bc, power_of_two(-size_exponent));
    pair_scale(&along, power_of_two(-speed_exponent));
    struct bounded_pair ea = triple(&along, &b, &bc), eb = triple(&along, &ac, &a);
    struct bounded_pair ec = triple(&along, &a, &ab);
    struct bounded_pair top = triple(&a, &ab, &ac), bottom = triple(&along, &ab, &ac);
    bool fit = is_fit(way) && is_fit(size) && is_fit(speed);
    float e[3] = {ea.value.high, eb.value.high, ec.value.high};
    float off[3] = {ea.error, eb.error, ec.error};
    int below = 0, above = 0;
    for (int i = 0; i < 3; ++i) {
        below += e[i] < -off[i];
        above += e[i] > off[i];
    }
    bool sided = fit && fabsf(bottom.value.high) > bottom.error;
    bool outside = fit && below > 0 && above > 0;
    bool inside = sided && (below == 3 || above == 3);
    bool behind = sided && fabsf(top.value.high) > top.error &&
                  (top.value.high < 0.0f) != (bottom.value.high < 0.0f);
    bool point = same(v0, v1) || same(v1, v2) || same(v2, v0);
    float t, to_weight = power_of_two(way_exponent - size_exponent);
    *key_known = round_ratio(top, bottom, &t) && fit;
    out->key = t * power_of_two(way_exponent - speed_exponent);
    out->u = e[1] / bottom.value.high * to_weight;
    out->v = e[2] / bottom.value.high * to_weight;
    out->met = inside && *key_known && !point;
    return outside || behind || point || out->met;
}

#include "twin/ff_triangle.h"

#include "twin/ff_numbers.h"

/* d.(a x b) for vectors up to length 2. */
static struct bounded_ff triple(const struct ff_vector *d, const struct ff_vector *a,
                                const struct ff_vector *b)
{
    struct vec3 ma = ff_magnitudes(a), mb = ff_magnitudes(b), md = ff_magnitudes(d);
    float x = ma.y * mb.z + ma.z * mb.y;
    float y = ma.z * mb.x + ma.x * mb.z;
    float z = ma.x * mb.y + ma.y * mb.x;
    float size = (md.x * x + md.y * y) + md.z * z;
    struct ff_vector normal = ff_cross(a, b);
    return (struct bounded_ff){ff_dot(d, &normal), size * FF_RELATIVE + FF_ABSOLUTE};
}

static bool same(struct vec3 a, struct vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* Vectors from a ray's origin to a triangle's vertices and between these, and the direction; each
   scaled to lengths up to 2, by these powers of two. */
struct ff_triangle {
    struct ff_vector a, b, ab, ac, bc, along;
    int way, size, speed;
    bool fit; /* they can be scaled */
};

static struct ff_triangle ff_triangle(struct vec3 origin, struct vec3 dir, struct vec3 v0,
                                      struct vec3 v1, struct vec3 v2)
{
    struct ff_triangle p = {.a = ff_difference(v0, origin),
                            .b = ff_difference(v1, origin),
                            .ab = ff_difference(v1, v0),
                            .ac = ff_difference(v2, v0),
                            .bc = ff_difference(v2, v1),
                            .along = {{dir.x, 0.0f}, {dir.y, 0.0f}, {dir.z, 0.0f}}};
    float way = float_larger(ff_largest(&p.a), ff_largest(&p.b));
    float size =
        float_larger(float_larger(ff_largest(&p.ab), ff_largest(&p.ac)), ff_largest(&p.bc));
    float speed = vec3_largest_magnitude(dir);
    p.fit = is_fit(way) && is_fit(size) && is_fit(speed);
    p.way = length_exponent(way);
    p.size = length_exponent(size);
    p.speed = length_exponent(speed);
    ff_scale(&p.a, power_of_two(-p.way));
    ff_scale(&p.b, power_of_two(-p.way));
    ff_scale(&p.ab, power_of_two(-p.size));
    ff_scale(&p.ac, power_of_two(-p.size));
    ff_scale(&p.bc, power_of_two(-p.size));
    ff_scale(&p.along, power_of_two(-p.speed));
    return p;
}

bool ff_meet(struct vec3 origin, struct vec3 dir, struct vec3 v0, struct vec3 v1, struct vec3 v2,
             struct exact_candidate *out, bool *key_known)
{
    struct ff_triangle p = ff_triangle(origin, dir, v0, v1, v2);
    const struct bounded_ff edges[3] = {triple(&p.along, &p.b, &p.bc),
                                        triple(&p.along, &p.ac, &p.a),
                                        triple(&p.along, &p.a, &p.ab)};
    struct bounded_ff top = triple(&p.a, &p.ab, &p.ac), bottom = triple(&p.along, &p.ab, &p.ac);
    int below = 0, above = 0;
    for (int i = 0; i < 3; ++i) {
        below += edges[i].value.high < -edges[i].error;
        above += edges[i].value.high > edges[i].error;
    }
    bool sided = p.fit && fabsf(bottom.value.high) > bottom.error;
    bool outside = p.fit && below > 0 && above > 0;
    bool inside = sided && (below == 3 || above == 3);
    bool behind = sided && fabsf(top.value.high) > top.error &&
                  (top.value.high < 0.0f) != (bottom.value.high < 0.0f);
    bool point = same(v0, v1) || same(v1, v2) || same(v2, v0);
    float t, to_weight = power_of_two(p.way - p.size);
    *key_known = round_ratio(top, bottom, &t) && p.fit;
    out->key = t * power_of_two(p.way - p.speed);
    out->u = edges[1].value.high / bottom.value.high * to_weight;
    out->v = edges[2].value.high / bottom.value.high * to_weight;
    out->met = inside && *key_known && !point;
    return outside || behind || point || out->met;
}

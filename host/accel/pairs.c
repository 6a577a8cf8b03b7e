#include "accel/pairs.h"

#include <stdint.h>
#include <string.h>

#define RELATIVE (1.0f / 2199023255552.0f)             /* 2^-41 */
#define ABSOLUTE (1.0f / 1208925819614629174706176.0f) /* 2^-80 */
#define LEAST    (1.0f / 1099511627776.0f)             /* 2^-40 */

struct pair {
    float high, low;
};

struct pair_vector {
    struct pair x, y, z;
};

/* Exact (Knuth's two-sum). */
static struct pair pair_sum(float a, float b)
{
    float s = a + b, from_b = s - a;
    return (struct pair){s, (a - (s - from_b)) + (b - from_b)};
}

static struct pair split(float a)
{
    float c = 4097.0f * a, high = c - (c - a);
    return (struct pair){high, a - high};
}

/* Exact, but for underflow. */
static struct pair pair_product(float a, float b)
{
    struct pair as = split(a), bs = split(b);
    float p = a * b;
    float error = ((as.high * bs.high - p) + as.high * bs.low + as.low * bs.high) + as.low * bs.low;
    return (struct pair){p, error};
}

static struct pair pair_times(struct pair a, struct pair b)
{
    struct pair p = pair_product(a.high, b.high);
    return pair_sum(p.high, p.low + (a.high * b.low + a.low * b.high));
}

static struct pair pair_plus(struct pair a, struct pair b)
{
    struct pair s = pair_sum(a.high, b.high);
    return pair_sum(s.high, s.low + (a.low + b.low));
}

static struct pair pair_minus(struct pair a, struct pair b)
{
    return pair_plus(a, (struct pair){-b.high, -b.low});
}

/* Exact. */
static struct pair_vector difference(struct vec3 a, struct vec3 b)
{
    return (struct pair_vector){pair_sum(a.x, -b.x), pair_sum(a.y, -b.y), pair_sum(a.z, -b.z)};
}

static struct vec3 magnitudes(const struct pair_vector *v)
{
    return (struct vec3){fabsf(v->x.high), fabsf(v->y.high), fabsf(v->z.high)};
}

static float largest_magnitude(const struct pair_vector *v)
{
    return vec3_largest_magnitude(magnitudes(v));
}

static struct pair_vector cross(const struct pair_vector *a, const struct pair_vector *b)
{
    return (struct pair_vector){pair_minus(pair_times(a->y, b->z), pair_times(a->z, b->y)),
                                pair_minus(pair_times(a->z, b->x), pair_times(a->x, b->z)),
                                pair_minus(pair_times(a->x, b->y), pair_times(a->y, b->x))};
}

static struct pair dot(const struct pair_vector *a, const struct pair_vector *b)
{
    return pair_plus(pair_plus(pair_times(a->x, b->x), pair_times(a->y, b->y)),
                     pair_times(a->z, b->z));
}

static int length_exponent(float largest)
{
    uint32_t bits;
    memcpy(&bits, &largest, sizeof bits);
    int exponent = (int)(bits >> 23 & 255) - 127;
    return exponent < -100 ? -100 : exponent > 100 ? 100 : exponent;
}

static float power_of_two(int exponent)
{
    uint32_t bits = (uint32_t)(exponent + 127) << 23;
    float power;
    memcpy(&power, &bits, sizeof power);
    return power;
}

static void scale(struct pair_vector *v, float power)
{
    *v = (struct pair_vector){{v->x.high * power, v->x.low * power},
                              {v->y.high * power, v->y.low * power},
                              {v->z.high * power, v->z.low * power}};
}

/* d.(a x b) of vectors up to 2, and how far it may be off. */
struct triple {
    struct pair value;
    float error;
};

static struct triple triple(const struct pair_vector *d, const struct pair_vector *a,
                            const struct pair_vector *b)
{
    struct vec3 ma = magnitudes(a), mb = magnitudes(b), md = magnitudes(d);
    float x = ma.y * mb.z + ma.z * mb.y;
    float y = ma.z * mb.x + ma.x * mb.z;
    float z = ma.x * mb.y + ma.y * mb.x;
    float size = (md.x * x + md.y * y) + md.z * z;
    struct pair_vector normal = cross(a, b);
    return (struct triple){dot(d, &normal), size * RELATIVE + ABSOLUTE};
}

/* t = top / bottom, rounded to nearest. False: not sure. */
static bool round_ratio(struct triple top, struct triple bottom, float *t)
{
    float first = top.value.high / bottom.value.high;
    struct pair back = pair_product(first, bottom.value.high);
    float rest =
        ((top.value.high - back.high) - back.low) + (top.value.low - first * bottom.value.low);
    struct pair both = pair_sum(first, rest / bottom.value.high);
    float size = fabsf(bottom.value.high);
    float error = top.error / size + fabsf(both.high) * (bottom.error / size + RELATIVE);
    uint32_t bits;
    memcpy(&bits, &both.high, sizeof bits);
    bits = both.low > 0.0f ? bits + 1 : bits - 1; /* t > 0 */
    float next;
    memcpy(&next, &bits, sizeof next);
    *t = both.high;
    return both.high > LEAST && size > LEAST &&
           fabsf(both.low) + error < 0.5f * fabsf(next - both.high);
}

static bool is_fit(float largest)
{
    return largest > 1.0f / 1099511627776.0f && largest < 1099511627776.0f;
}

static bool same(struct vec3 a, struct vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

bool pair_meet(struct vec3 origin, struct vec3 dir, struct vec3 v0, struct vec3 v1, struct vec3 v2,
               struct exact_meeting *out, bool *key_known)
{
    struct pair_vector a = difference(v0, origin), b = difference(v1, origin);
    struct pair_vector ab = difference(v1, v0), ac = difference(v2, v0), bc = difference(v2, v1);
    struct pair_vector along = {{dir.x, 0.0f}, {dir.y, 0.0f}, {dir.z, 0.0f}};
    float way = float_larger(largest_magnitude(&a), largest_magnitude(&b));
    float size = float_larger(float_larger(largest_magnitude(&ab), largest_magnitude(&ac)),
                              largest_magnitude(&bc));
    float speed = vec3_largest_magnitude(dir);
    int way_exponent = length_exponent(way), size_exponent = length_exponent(size);
    int speed_exponent = length_exponent(speed);
    scale(&a, power_of_two(-way_exponent));
    scale(&b, power_of_two(-way_exponent));
    scale(&ab, power_of_two(-size_exponent));
    scale(&ac, power_of_two(-size_exponent));
    scale(&bc, power_of_two(-size_exponent));
    scale(&along, power_of_two(-speed_exponent));
    struct triple ea = triple(&along, &b, &bc), eb = triple(&along, &ac, &a);
    struct triple ec = triple(&along, &a, &ab);
    struct triple top = triple(&a, &ab, &ac), bottom = triple(&along, &ab, &ac);
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

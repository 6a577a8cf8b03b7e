#include "oracle/rational.h"

#include <float.h>
#include <gmp.h>
#include <math.h>
#include <stdlib.h>
#include <strings.h>

#include "accel/accel.h"
#include "accel/hit_order.h"
#include "oracle/conservative.h"
#include "twin/ray.h"

/* Relative growth of boxes, more than the rounding errors of the walk's doubles (about 2^-50). */
#define BOX_GROWTH 0x1p-40

enum { VERTICES = 3, AXES = 3 };

/* The quadratic P t^2 - 2 S t + Q, t in units of 2^power, and a quarter of its discriminant. */
struct quadratic {
    mpz_t p, s, q, disc;
    mpz_t at, shifted, slope, value, root; /* scratch */
    int power;
};

struct rational {
    const struct accel *accel;
    double instance_growth, instance_scale; /* see instance_spread */
    struct rational_work work;
    /* Scratch numbers of rational_meet. */
    mpz_t dir[AXES], vertex[VERTICES][AXES]; /* vertices relative to the origin */
    mpz_t cross[AXES], edge[VERTICES], volume, det, rest;
    struct quadratic sphere; /* of rational_meet_sphere, besides `dir`, `vertex` and `rest` */
};

/* ---- In integers ---- */

static void init_numbers(struct rational *r)
{
    for (int k = 0; k < AXES; ++k)
        mpz_inits(r->dir[k], r->cross[k], r->edge[k], r->vertex[0][k], r->vertex[1][k],
                  r->vertex[2][k], NULL);
    mpz_inits(r->volume, r->det, r->rest, NULL);
    struct quadratic *f = &r->sphere;
    mpz_inits(f->p, f->s, f->q, f->disc, f->at, f->shifted, f->slope, f->value, f->root, NULL);
}

static void clear_numbers(struct rational *r)
{
    for (int k = 0; k < AXES; ++k)
        mpz_clears(r->dir[k], r->cross[k], r->edge[k], r->vertex[0][k], r->vertex[1][k],
                   r->vertex[2][k], NULL);
    mpz_clears(r->volume, r->det, r->rest, NULL);
    struct quadratic *f = &r->sphere;
    mpz_clears(f->p, f->s, f->q, f->disc, f->at, f->shifted, f->slope, f->value, f->root, NULL);
}

/* The power of two that the lowest set bit of a float stands for; 0 has none. */
static int lowest_power(float value, int none)
{
    int exponent;
    int mantissa = (int)ldexpf(frexpf(value, &exponent), FLT_MANT_DIG);
    return mantissa == 0 ? none : exponent - FLT_MANT_DIG + ffs(mantissa) - 1;
}

static int lowest_of(struct vec3 v, int lowest)
{
    const float values[AXES] = {v.x, v.y, v.z};
    for (int k = 0; k < AXES; ++k) {
        int power = lowest_power(values[k], lowest);
        lowest = power < lowest ? power : lowest;
    }
    return lowest;
}

/* Sets integers to the coordinates in units of 2^power, which must divide them. A float has 24 bits
   at any exponent, so the double given to mpz_set_d is exact. */
static void set_scaled(mpz_t out[AXES], struct vec3 v, int power)
{
    mpz_set_d(out[0], ldexp((double)v.x, -power));
    mpz_set_d(out[1], ldexp((double)v.y, -power));
    mpz_set_d(out[2], ldexp((double)v.z, -power));
}

static void set_cross(mpz_t out[AXES], mpz_t a[AXES], mpz_t b[AXES])
{
    for (int k = 0; k < AXES; ++k) {
        int i = (k + 1) % AXES, j = (k + 2) % AXES;
        mpz_mul(out[k], a[i], b[j]);
        mpz_submul(out[k], a[j], b[i]);
    }
}

static void set_dot(mpz_t out, mpz_t a[AXES], mpz_t b[AXES])
{
    mpz_mul(out, a[0], b[0]);
    mpz_addmul(out, a[1], b[1]);
    mpz_addmul(out, a[2], b[2]);
}

/* over / under * 2^power, rounded to float. Destroys both numbers. The quotient is computed to some
   40 bits and one more bit that tells whether anything remains. That is enough for a double to lie
   on the same side as the quotient of every float and every middle of two, and to equal one only
   where the quotient does. */
static float round_quotient(mpz_t over, mpz_t under, mpz_t rest, int power)
{
    if (mpz_sgn(over) == 0)
        return 0.0f;
    int sign = mpz_sgn(over) * mpz_sgn(under);
    int shift = 40 + (int)mpz_sizeinbase(under, 2) - (int)mpz_sizeinbase(over, 2);
    mpz_abs(over, over);
    mpz_abs(under, under);
    if (shift > 0)
        mpz_mul_2exp(over, over, (mp_bitcnt_t)shift);
    else
        mpz_mul_2exp(under, under, (mp_bitcnt_t)-shift);
    mpz_tdiv_qr(over, rest, over, under);
    double bits = 2.0 * mpz_get_d(over) + (mpz_sgn(rest) != 0 ? 1.0 : 0.0);
    return (float)ldexp(sign * bits, power - shift - 1) + 0.0f;
}

/* Computes the edge functions and their sum. False when their signs or a sum of 0 mean a miss. */
static bool set_edges(struct rational *r, uint32_t *edges)
{
    bool below = false, above = false;
    *edges = 0;
    for (int i = 0; i < VERTICES; ++i) {
        set_cross(r->cross, r->vertex[(i + 1) % VERTICES], r->vertex[(i + 2) % VERTICES]);
        set_dot(r->edge[i], r->dir, r->cross);
        int sign = mpz_sgn(r->edge[i]);
        below |= sign < 0;
        above |= sign > 0;
        *edges += sign == 0;
        if (below && above)
            return false;
    }
    mpz_add(r->det, r->edge[0], r->edge[1]);
    mpz_add(r->det, r->det, r->edge[2]);
    return mpz_sgn(r->det) != 0;
}

bool rational_meet(struct rational *r, struct vec3 origin, struct vec3 dir, const struct vec3 v[3],
                   float *key, uint32_t *edges)
{
    uint32_t on_edges;
    /* FLT_MAX_EXP is above every power, so it stands for "none"; if all numbers are 0, they are 0
       in any unit. */
    int unit = lowest_of(origin, FLT_MAX_EXP), dir_unit = lowest_of(dir, FLT_MAX_EXP);
    for (int i = 0; i < VERTICES; ++i)
        unit = lowest_of(v[i], unit);
    set_scaled(r->dir, dir, dir_unit);
    set_scaled(r->cross, origin, unit);
    for (int i = 0; i < VERTICES; ++i) {
        set_scaled(r->vertex[i], v[i], unit);
        for (int k = 0; k < AXES; ++k)
            mpz_sub(r->vertex[i][k], r->vertex[i][k], r->cross[k]);
    }
    if (!set_edges(r, &on_edges))
        return false;
    set_cross(r->cross, r->vertex[1], r->vertex[2]);
    set_dot(r->volume, r->vertex[0], r->cross);
    /* The volume's unit is three lengths, that of D two lengths times the direction's unit. */
    *key = round_quotient(r->volume, r->det, r->rest, unit - dir_unit);
    if (edges)
        *edges = on_edges;
    return isfinite(*key);
}

/* ---- Spheres, in integers ---- */

/* Sign of (the near or far root - at), with `at` a double. It follows from the sign of the
   quadratic at `at` and from that of half its slope there, which tells the side of the vertex. */
static int compare_root(struct quadratic *f, bool far, double at)
{
    int exponent;
    double fraction = frexp(at, &exponent);
    int shift = exponent - DBL_MANT_DIG - f->power;
    mpz_set_d(f->at, ldexp(fraction, DBL_MANT_DIG));
    mp_bitcnt_t down = shift < 0 ? (mp_bitcnt_t)-shift : 0;
    if (shift > 0)
        mpz_mul_2exp(f->at, f->at, (mp_bitcnt_t)shift);
    /* slope = P a - S', value = a (P a - 2 S') + Q', with a = at 2^down, and S' and Q' scaled to
       match. */
    mpz_mul_2exp(f->shifted, f->s, down);
    mpz_mul(f->slope, f->p, f->at);
    mpz_sub(f->slope, f->slope, f->shifted);
    mpz_sub(f->value, f->slope, f->shifted);
    mpz_mul(f->value, f->value, f->at);
    mpz_mul_2exp(f->shifted, f->q, 2 * down);
    mpz_add(f->value, f->value, f->shifted);
    int slope = mpz_sgn(f->slope), value = mpz_sgn(f->value);
    if (far)
        return slope >= 0 ? -value : 1;
    return slope <= 0 ? value : -1;
}

/* Floats >= 0 are in the order of their bits. The largest is followed by 2^128, the next value of
   the pattern, so that keys become infinite from the middle of both on. */
#define INFINITE_BITS 0x7f800000u

static double value_of_bits(uint32_t bits)
{
    return bits == INFINITE_BITS ? 0x1p128 : (double)float_of_bits(bits);
}

/* Whether the root rounds to a float above the one with these bits: it is beyond the middle of this
   float and the next, or at the middle where the next one is even. A double holds the middle. */
static bool is_above(struct quadratic *f, bool far, uint32_t bits)
{
    double middle = 0.5 * (value_of_bits(bits) + value_of_bits(bits + 1));
    int side = compare_root(f, far, middle);
    return side > 0 || (side == 0 && bits % 2 == 1);
}

/* Some 60 bits of the root, which is >= 0: from as many bits of the square root, and either a sum
   of two numbers with the same sign or Q over that sum. */
static float estimate_root(struct quadratic *f, bool far, mpz_t rest)
{
    enum { BITS = 64 };
    bool ahead = mpz_sgn(f->s) >= 0;
    mpz_mul_2exp(f->root, f->disc, 2 * BITS);
    mpz_sqrt(f->root, f->root);
    mpz_mul_2exp(f->shifted, f->s, BITS);
    if (ahead)
        mpz_add(f->root, f->root, f->shifted);
    else
        mpz_sub(f->root, f->shifted, f->root);
    bool is_sum = far == ahead;
    mpz_mul_2exp(f->value, is_sum ? f->p : f->q, BITS);
    return is_sum ? round_quotient(f->root, f->value, rest, f->power)
                  : round_quotient(f->value, f->root, rest, f->power);
}

/* The key of a root >= 0. The signs of integers decide on which side of the middles between floats
   the root is; the estimate only makes the search short. */
static float round_root(struct quadratic *f, bool far, mpz_t rest)
{
    uint32_t bits = float_bits(estimate_root(f, far, rest));
    while (bits < INFINITE_BITS && is_above(f, far, bits))
        ++bits;
    while (bits > 0 && !is_above(f, far, bits - 1))
        --bits;
    return float_of_bits(bits);
}

static void set_quadratic(struct rational *r, struct vec3 origin, struct vec3 dir,
                          struct vec3 center, float radius)
{
    struct quadratic *f = &r->sphere;
    mpz_t *m = r->vertex[0];
    int dir_unit = lowest_of(dir, FLT_MAX_EXP);
    int unit = lowest_of(center, lowest_of(origin, FLT_MAX_EXP));
    int radius_unit = lowest_power(radius, unit);
    unit = radius_unit < unit ? radius_unit : unit;
    set_scaled(r->dir, dir, dir_unit);
    set_scaled(r->cross, origin, unit);
    set_scaled(m, center, unit);
    for (int k = 0; k < AXES; ++k)
        mpz_sub(m[k], m[k], r->cross[k]);
    set_dot(f->p, r->dir, r->dir);
    set_dot(f->s, m, r->dir);
    set_dot(f->q, m, m);
    mpz_set_d(f->value, ldexp((double)radius, -unit));
    mpz_submul(f->q, f->value, f->value);
    mpz_mul(f->disc, f->s, f->s);
    mpz_submul(f->disc, f->p, f->q);
    f->power = unit - dir_unit;
}

bool rational_meet_sphere(struct rational *r, struct vec3 origin, struct vec3 dir,
                          struct vec3 center, float radius, struct rational_chord *out)
{
    struct quadratic *f = &r->sphere;
    set_quadratic(r, origin, dir, center, radius);
    if (mpz_sgn(f->disc) < 0)
        return false;
    /* The sum of the roots is 2 S / P, their product is Q / P. */
    int sum = mpz_sgn(f->s), product = mpz_sgn(f->q);
    *out = (struct rational_chord){.near_there = sum >= 0 && product >= 0,
                                   .far_there = sum >= 0 || product <= 0,
                                   .inward = sum > 0};
    if (out->near_there)
        out->near_key = round_root(f, false, r->rest);
    if (out->far_there)
        out->far_key = round_root(f, true, r->rest);
    out->near_there &= isfinite(out->near_key) != 0;
    out->far_there &= isfinite(out->far_key) != 0;
    return out->near_there || out->far_there;
}

/* ---- In double, where that is enough ----

   Let u = 2^-53. Coordinates relative to the origin are floats' differences: off by a factor within
   1 +- u. A product b.y c.z carries three such factors, the difference that makes the cross product
   one more, the product with d or with a coordinate of a (another u) one, the sums of three two. So

       |error of e| <= ((1 + u)^7 - 1) S,   S = sum of |d.x| (|b.y c.z| + |b.z c.y|) ...

   and 8 instead of 7 for the volume N. S itself is computed with as few, so that 16 u times what
   comes out for it is more than the error. Nothing underflows: a difference of floats is 0 or at
   least 2^-149, a product of three of them at least 2^-447; or overflows, at 2^129 each. */
#define PRODUCT_ERROR 0x1p-49

struct bounded {
    double value, error;
};

/* p.(q x r) */
static struct bounded triple(const double p[3], const double q[3], const double r[3])
{
    double sum = 0.0, size = 0.0;
    for (int k = 0; k < AXES; ++k) {
        int i = (k + 1) % AXES, j = (k + 2) % AXES;
        double left = q[i] * r[j], right = q[j] * r[i];
        sum += p[k] * (left - right);
        size += fabs(p[k]) * (fabs(left) + fabs(right));
    }
    return (struct bounded){sum, PRODUCT_ERROR * size};
}

enum opinion { NOT_MET, MET, UNSURE };

struct estimate {
    enum opinion met;
    uint32_t edges; /* valid if it is met */
    float min, max; /* bounds of the key, valid if it is met */
};

/* t = N / D. With errors n of N and m of D, |error of t| <= (n + |t| m) / (|D| - m), and a few u of
   t. Rounding is monotonic, so the key lies between the rounded bounds of t. */
static void estimate_key(struct estimate *out, double v[3][3], const struct bounded edge[3])
{
    struct bounded volume = triple(v[0], v[1], v[2]);
    double det = 0.0, det_error = 0.0;
    for (int i = 0; i < VERTICES; ++i) {
        det += edge[i].value;
        det_error += edge[i].error + 0x1p-52 * fabs(edge[i].value);
    }
    out->min = -INFINITY;
    out->max = INFINITY;
    if (!(fabs(det) > 2.0 * det_error))
        return;
    double t = volume.value / det;
    double error =
        1.001 * (volume.error + fabs(t) * det_error) / (fabs(det) - det_error) + 0x1p-50 * fabs(t);
    out->min = (float)(t - error) + 0.0f;
    out->max = (float)(t + error) + 0.0f;
}

static struct estimate estimate_candidate(const double origin[3], const double dir[3],
                                          const struct gpu_triangle *triangle)
{
    const float *corner[VERTICES] = {triangle->v0, triangle->v1, triangle->v2};
    double v[VERTICES][3];
    struct bounded edge[VERTICES];
    bool below = false, above = false, unsure = false;
    struct estimate out = {NOT_MET, 0, -INFINITY, INFINITY};
    for (int i = 0; i < VERTICES; ++i)
        for (int k = 0; k < AXES; ++k)
            v[i][k] = (double)corner[i][k] - origin[k];
    for (int i = 0; i < VERTICES; ++i) {
        edge[i] = triple(dir, v[(i + 1) % VERTICES], v[(i + 2) % VERTICES]);
        bool zero = edge[i].error == 0.0; /* every product is 0 */
        bool sure = fabs(edge[i].value) > edge[i].error;
        below |= sure && edge[i].value < 0.0;
        above |= sure && edge[i].value > 0.0;
        unsure |= !sure && !zero;
        out.edges += zero;
    }
    if ((below && above) || out.edges == VERTICES)
        return out;
    out.met = unsure ? UNSURE : MET;
    estimate_key(&out, v, edge);
    return out;
}

/* Whether the line surely misses the sphere. |m x d|^2 - r^2 d.d is minus the discriminant.
   Products of the cross product m x d have errors as those above, with two factors fewer; the sum
   of squares adds a few u, as r^2 d.d does. Nothing underflows here either: squares are 0 or at
   least 2^-702, and at most 2^517. */
static bool surely_misses(const double origin[3], const double dir[3],
                          const struct gpu_triangle *sphere)
{
    double m[AXES], off = 0.0, size = 0.0, radius = (double)sphere->v1[0];
    for (int k = 0; k < AXES; ++k) {
        m[k] = (double)sphere->v0[k] - origin[k];
        size += dir[k] * dir[k];
    }
    for (int k = 0; k < AXES; ++k) {
        int i = (k + 1) % AXES, j = (k + 2) % AXES;
        double left = m[i] * dir[j], right = m[j] * dir[i];
        double min = fabs(left - right) - PRODUCT_ERROR * (fabs(left) + fabs(right));
        off += min > 0.0 ? min * min : 0.0;
    }
    return off > (1.0 + 0x1p-48) * radius * radius * size;
}

/* ---- Every primitive that matters ---- */

struct search {
    struct conservative_walk walk; /* must come first: callbacks cast it to struct search */
    struct rational *rational;
    const struct rational_query *query;
    const struct gpu_ray *world;
    struct gpu_ray ray; /* the ray in the space of walk->ray */
    float t_max;
    struct rational_hit best;
};

static struct hit_place place_of(const struct rational_hit *hit)
{
    return (struct hit_place){(double)hit->t, hit->instance, hit->primitive};
}

static bool is_own(uint32_t instance, uint32_t primitive, const struct rational_hit *own)
{
    return instance == own->instance && (primitive == own->primitive || own->primitive == SKIP_ALL);
}

/* Whether a hit is in range and comes after query->behind; a sphere's far end does if its key is
   larger. */
static bool may_count(const struct search *s, float t, uint32_t instance, uint32_t primitive)
{
    return t >= s->world->t_min && t <= s->t_max &&
           (!s->query->behind ||
            hit_comes_before(place_of(s->query->behind),
                             (struct hit_place){(double)t, instance, primitive}));
}

static void offer_hit(struct search *s, float t, uint32_t edges, uint32_t instance,
                      uint32_t primitive)
{
    if (!may_count(s, t, instance, primitive) ||
        !hit_comes_before((struct hit_place){(double)t, instance, primitive}, place_of(&s->best)))
        return;
    s->best = (struct rational_hit){t, primitive, instance, edges};
    s->walk.limit = (double)t;
    s->walk.done = s->query->any;
}

static void visit_exactly(struct search *s, const struct gpu_triangle *triangle, uint32_t instance)
{
    const struct vec3 v[VERTICES] = {vec3_load(triangle->v0), vec3_load(triangle->v1),
                                     vec3_load(triangle->v2)};
    float key;
    uint32_t edges;
    ++s->rational->work.exact;
    if (rational_meet(s->rational, vec3_load(s->ray.origin), vec3_load(s->ray.dir), v, &key,
                      &edges))
        offer_hit(s, key, edges, instance, triangle->primitive);
}

static void visit_sphere(struct search *s, const struct gpu_triangle *sphere, uint32_t instance,
                         bool own)
{
    struct rational_chord chord;
    own &= !s->query->behind;
    if (!s->query->brute && surely_misses(s->walk.ray.origin, s->walk.ray.dir, sphere))
        return;
    ++s->rational->work.exact;
    if (!rational_meet_sphere(s->rational, vec3_load(s->ray.origin), vec3_load(s->ray.dir),
                              vec3_load(sphere->v0), sphere->v1[0], &chord) ||
        (own && !chord.inward))
        return;
    if (chord.near_there && !own && may_count(s, chord.near_key, instance, sphere->primitive))
        offer_hit(s, chord.near_key, 0, instance, sphere->primitive);
    else if (chord.far_there)
        offer_hit(s, chord.far_key, 0, instance, sphere->primitive);
}

static void visit_record(struct conservative_walk *walk, uint32_t record, uint32_t instance)
{
    struct search *s = (struct search *)walk;
    const struct gpu_triangle *triangle = &walk->accel->triangles[record];
    bool own = s->query->own && is_own(instance, triangle->primitive, s->query->own);
    bool sphere = triangle->flags & TRIANGLE_SPHERE;
    if (own && !sphere)
        return;
    ++s->rational->work.primitives;
    if (sphere) {
        visit_sphere(s, triangle, instance, own);
        return;
    }
    if (s->query->brute) {
        visit_exactly(s, triangle, instance);
        return;
    }
    struct estimate e = estimate_candidate(walk->ray.origin, walk->ray.dir, triangle);
    if (e.met == NOT_MET || e.max < s->world->t_min || e.min > s->t_max || e.min > s->best.t)
        return;
    if (e.met == MET && e.min == e.max && isfinite(e.min))
        offer_hit(s, e.min, e.edges, instance, triangle->primitive);
    else
        visit_exactly(s, triangle, instance);
}

/* Sets the ray for the tree to walk next. */
static bool set_ray(struct search *s, const struct gpu_ray *ray)
{
    s->ray = *ray;
    s->walk.ray = (struct conservative_ray){
        .t_min = (double)ray->t_min, .t_max = (double)s->t_max, .growth = BOX_GROWTH};
    for (int k = 0; k < AXES; ++k) {
        s->walk.ray.origin[k] = (double)ray->origin[k];
        s->walk.ray.dir[k] = (double)ray->dir[k];
    }
    return accel_ray_is_usable(ray);
}

static bool enter_instance(struct conservative_walk *walk, uint32_t instance)
{
    struct search *s = (struct search *)walk;
    struct gpu_ray local = accel_local_ray(&walk->accel->instances[instance], s->world);
    return set_ray(s, &local);
}

/* Widens the boxes of the tree over instances; see instance_spread. */
static void widen_for_instances(const struct rational *rational, struct conservative_ray *ray)
{
    double dir = fmax(fmax(fabs(ray->dir[0]), fabs(ray->dir[1])), fabs(ray->dir[2]));
    ray->growth = rational->instance_growth + rational->instance_scale * 0x1p-146 / dir;
    ray->margin = rational->instance_scale * 0x1p-146;
}

void rational_trace(struct rational *rational, const struct gpu_ray *ray,
                    const struct rational_query *query, struct rational_hit *hit)
{
    static const struct rational_query closest;
    const struct accel *accel = rational->accel;
    struct search s = {
        .walk = {.accel = accel, .limit = INFINITY, .enter = enter_instance, .visit = visit_record},
        .rational = rational,
        .query = query ? query : &closest,
        .world = ray,
        .t_max = ray->t_max < FLT_MAX ? ray->t_max : FLT_MAX,
        .best = {.t = INFINITY, .primitive = HIT_NONE, .instance = HIT_NONE}};
    s.walk.brute = s.query->brute;
    if (set_ray(&s, ray) && ray->t_min <= s.t_max) {
        if (!accel->single_identity && !accel->flat)
            widen_for_instances(rational, &s.walk.ray);
        conservative_walk_run(&s.walk);
    }
    *hit = s.best;
}

/* ---- What belongs to the scene ---- */

/* Boxes of the tree over instances are in the world, and what they hold is hit by the object-space
   ray. With M the floats of the inverse, F those of the matrix, T the origin and r = 2^-24, that
   ray is off by 4 r |M| |p - T| at its origin and 3 r |M| |w| in its direction w. A hit x at t is
   therefore, in the world, off X = p + t w by less than

       r |F| |M| (4 |p - T| + 3 t |w| + |X - T|) <= r |F| |M| (7 |p - X| + 5 |X - T|),

   the last of it because M is rounded too. pose.c makes boxes wider by 16 r of |F| |M| times the
   coordinates that X - T is made of; the rest is 7 r |F| |M| of the distance from the ray's origin,
   and its largest row is what boxes grow by here.

   What underflows adds up to four denormals to the origin, and t <= |p - X| / |w| times as much by
   the direction; |F| takes that to the world. */
static double instance_spread(const struct gpu_instance *i, double *scale)
{
    const float *forward[3] = {i->forward0, i->forward1, i->forward2};
    const float *inverse[3] = {i->inverse0, i->inverse1, i->inverse2};
    double max = 0.0;
    for (int r = 0; r < AXES; ++r) {
        double sum = 0.0;
        for (int c = 0; c < AXES; ++c) {
            *scale = fmax(*scale, fabs((double)forward[r][c]));
            for (int k = 0; k < AXES; ++k)
                sum += fabs((double)forward[r][k] * (double)inverse[k][c]);
        }
        max = fmax(max, sum);
    }
    return max;
}

struct rational *rational_create(const struct accel *accel)
{
    struct rational *rational = calloc(1, sizeof *rational);
    if (!rational)
        return NULL;
    rational->accel = accel;
    init_numbers(rational);
    double spread = 1.0;
    for (uint32_t i = 0; accel && !accel->flat && i < accel->instance_count; ++i)
        spread = fmax(spread, instance_spread(&accel->instances[i], &rational->instance_scale));
    rational->instance_growth = 0x1p-20 * spread;
    return rational;
}

void rational_destroy(struct rational *rational)
{
    if (!rational)
        return;
    clear_numbers(rational);
    free(rational);
}

struct rational_work rational_work(const struct rational *rational)
{
    return rational->work;
}

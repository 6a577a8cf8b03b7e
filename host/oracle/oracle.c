/* Closest hits in double, with how far the float test is from deciding otherwise.

   The float test (intersect.h) works on A = vertex - origin, sheared along the dominant axis z of
   the direction: a = A.x - S.x A.z, and likewise in y, with S.x = d.x / d.z. Let r = 2^-24 be one
   rounding. A.x and A.z carry one each, S.x one (its division), the product one, the difference
   one:

       |error of a| <= r (|A.x| + 3 |S.x A.z| + |a|) <= r (2 |A.x| + 4 |S.x A.z|).

   In an instance the float ray itself is off: its origin o = M (p - T) by 4 r |M| |p - T| on each
   axis (difference, product, two sums) and its direction d = M w by 3 r |M| |w|. That adds
   error(o.x) + |S.x| error(o.z) + |A.z| (error(d.x) + |S.x| error(d.z)) / |d.z|.

   An edge function U = c.x b.y - c.y b.x then errs by what its factors carry, plus two roundings of
   each product (itself, and the difference). The float test says "hit" when no two edge functions
   differ in sign, so |U| / error(U), smallest over the edges that matter, tells how many error
   bounds away the other answer is: below 1 it is possible. t = (sum of U z) / (sum of U) errs by
   the same rules; float clamps it to the triangle's box, which moves it by at most 4 r |t|.
   Products of errors are kept; one denormal is added to everything that may underflow. A sum of U
   that is denormal may have no reciprocal in floats, so that nothing is sure of such a triangle.
   The oracle's own roundings are 2^-29 of all this.

   The test of a sphere (sphere.h) works on C = centre - origin, off by r |C| on each axis, and on
   D = (S.x, S.y, 1). With m = C.D / D.D, the perpendicular L = C - m D errs by what C, D and the
   two roundings of each axis bring, and along D by the error of m. L stands on D, so that the
   latter enters L.L by its square only:

       error(L.L) = 2 |L| e + (e + error(m) |D|)^2 + 3 r L.L,   e = error(C) + |m| error(D) + 2 r
   (..)

   The line meets the sphere when R^2 - L.L is not negative; how far that is from 0, in its error
   bounds, is the margin. t comes from m, from the root of that over D.D, and, at the end of the
   chord that is nearer to the origin, from C.C - R^2, whose error is 2 |C| error(C) + 4 r (C.C +
   R^2). */
#include <float.h>
#include <math.h>
#include <string.h>

#include "accel/accel.h"
#include "accel/extent.h"
#include "accel/hit_order.h"
#include "oracle/conservative.h"
#include "oracle/oracle.h"
#include "twin/ray.h"

#define ROUNDING   0x1p-24
#define DENORMAL   0x1p-149
#define NORMAL_MIN 0x1p-126
/* Boxes are widened by this share of the distance to the ray's origin: hits of the float test lie
   within 16 roundings of a box. */
#define BOX_GROWTH 0x1p-18

struct probe {
    double origin[3], dir[3];
    double origin_error[3], dir_error[3];
    int x, y, z; /* z: the dominant axis */
    double shear[3];
    double t_min, t_max;
    double origin_error_largest;
    double box_growth;
};

/* The result of the test in double for one primitive, and how far the opposite result is. */
struct verdict {
    bool hit; /* by the edges only, regardless of t_min and t_max */
    double t, u, v, t_error;
    double margin; /* distance from the opposite result, in error bounds, >= 0 */
    double choice; /* of a sphere: how far its other end is from being taken, in error bounds */
};

struct point {
    double x, y, z;
    double x_error, y_error, z_error;
};

struct number {
    double value, error;
};

/* Chooses the dominant axis as make_ray_setup does: ties go to z, then y. */
static void probe_shear(struct probe *p)
{
    double x = fabs(p->dir[0]), y = fabs(p->dir[1]), z = fabs(p->dir[2]);
    p->z = x > y && x > z ? 0 : !(x > y) && y > z ? 1 : 2;
    p->x = (p->z + 1) % 3;
    p->y = (p->z + 2) % 3;
    p->shear[0] = p->dir[p->x] / p->dir[p->z];
    p->shear[1] = p->dir[p->y] / p->dir[p->z];
    p->shear[2] = 1.0 / p->dir[p->z];
    p->origin_error_largest =
        fmax(fmax(p->origin_error[0], p->origin_error[1]), p->origin_error[2]);
}

static struct probe probe_world(const struct gpu_ray *ray, double growth)
{
    struct probe p = {.t_min = (double)ray->t_min,
                      .t_max = (double)(ray->t_max < FLT_MAX ? ray->t_max : FLT_MAX),
                      .box_growth = growth};
    for (int i = 0; i < 3; ++i) {
        p.origin[i] = (double)ray->origin[i];
        p.dir[i] = (double)ray->dir[i];
    }
    probe_shear(&p);
    return p;
}

/* The ray in an instance's object space, by the instance's float matrix, so that it differs from
   that of the float mirror only by rounding. */
static struct probe probe_local(const struct probe *world, const struct gpu_instance *in)
{
    const float *rows[3] = {in->inverse0, in->inverse1, in->inverse2};
    const float at[3] = {in->origin_x, in->origin_y, in->origin_z};
    struct probe p = {.t_min = world->t_min, .t_max = world->t_max, .box_growth = BOX_GROWTH};
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            double m = (double)rows[r][c], relative = world->origin[c] - (double)at[c];
            p.origin[r] += m * relative;
            p.dir[r] += m * world->dir[c];
            p.origin_error[r] += 4.0 * ROUNDING * fabs(m * relative) + DENORMAL;
            p.dir_error[r] += 3.0 * ROUNDING * fabs(m * world->dir[c]) + DENORMAL;
        }
    }
    probe_shear(&p);
    return p;
}

static struct number sheared(double a, double z, double shear, double a_error, double z_error,
                             double shear_error)
{
    struct number out = {.value = a - shear * z};
    out.error = ROUNDING * (2.0 * fabs(a) + 4.0 * fabs(shear * z)) + a_error +
                fabs(shear) * z_error + fabs(z) * shear_error + DENORMAL;
    return out;
}

static struct point probe_point(const struct probe *p, const float vertex[3])
{
    double a[3];
    for (int i = 0; i < 3; ++i)
        a[i] = (double)vertex[i] - p->origin[i];
    double x = a[p->x], y = a[p->y], z = a[p->z], dz = fabs(p->dir[p->z]);
    const double *oe = p->origin_error, *de = p->dir_error;
    struct number sx = sheared(x, z, p->shear[0], oe[p->x], oe[p->z],
                               (de[p->x] + fabs(p->shear[0]) * de[p->z]) / dz);
    struct number sy = sheared(y, z, p->shear[1], oe[p->y], oe[p->z],
                               (de[p->y] + fabs(p->shear[1]) * de[p->z]) / dz);
    struct point out = {.x = sx.value, .y = sy.value, .z = p->shear[2] * z};
    out.x_error = sx.error;
    out.y_error = sy.error;
    out.z_error = fabs(out.z) * (3.0 * ROUNDING + de[p->z] / dz) + fabs(p->shear[2]) * oe[p->z];
    return out;
}

/* c.x b.y - c.y b.x */
static struct number edge_function(const struct point *c, const struct point *b)
{
    double left = (fabs(c->x) + c->x_error) * (fabs(b->y) + b->y_error);
    double right = (fabs(c->y) + c->y_error) * (fabs(b->x) + b->x_error);
    struct number out = {.value = c->x * b->y - c->y * b->x};
    out.error = (left - fabs(c->x * b->y)) + (right - fabs(c->y * b->x)) +
                2.0 * ROUNDING * (left + right) + 2.0 * DENORMAL;
    return out;
}

/* The margin by edge functions: a hit is lost when any of them changes sign; a miss becomes a hit
   when all of one sign do. */
static double edges_margin(const struct number edge[3], bool hit)
{
    double min = INFINITY, below = 0.0, above = 0.0;
    for (int i = 0; i < 3; ++i) {
        double bounds = fabs(edge[i].value) / edge[i].error;
        min = fmin(min, bounds);
        if (edge[i].value < 0.0)
            below = fmax(below, bounds);
        else
            above = fmax(above, bounds);
    }
    return hit ? min : fmin(below, above);
}

static struct verdict probe_triangle(const struct probe *p, const struct gpu_triangle *triangle)
{
    struct point a = probe_point(p, triangle->v0), b = probe_point(p, triangle->v1),
                 c = probe_point(p, triangle->v2);
    struct number edge[3] = {edge_function(&c, &b), edge_function(&a, &c), edge_function(&b, &a)};
    const struct point *corner[3] = {&a, &b, &c};
    bool below = false, above = false;
    double det = 0.0, det_error = 0.0, sum = 0.0, sum_error = 0.0;
    for (int i = 0; i < 3; ++i) {
        double u = edge[i].value, z = corner[i]->z;
        below |= u < 0.0;
        above |= u > 0.0;
        det += u;
        det_error += edge[i].error + 2.0 * ROUNDING * fabs(u);
        sum += u * z;
        sum_error += edge[i].error * fabs(z) + (fabs(u) + edge[i].error) * corner[i]->z_error +
                     4.0 * ROUNDING * fabs(u * z) + DENORMAL;
    }
    struct verdict out = {
        .hit = !(below && above) && det != 0.0, .t_error = INFINITY, .choice = INFINITY};
    out.margin = fabs(det) < NORMAL_MIN ? 0.0 : edges_margin(edge, out.hit);
    if (det != 0.0) {
        out.t = sum / det;
        out.u = edge[1].value / det;
        out.v = edge[2].value / det;
    }
    if (fabs(det) > det_error)
        out.t_error = (sum_error + fabs(out.t) * det_error) / (fabs(det) - det_error) +
                      8.0 * ROUNDING * fabs(out.t) + DENORMAL;
    return out;
}

/* ---- Spheres ---- */

/* The chord of a ray's line through a sphere, measured along the dominant axis. */
struct chord {
    double room, room_error; /* squared radius less the squared distance of the line */
    struct number length_squared, middle, half, begin, end;
};

static struct number number_of_axis(const struct probe *p, int axis)
{
    double dz = fabs(p->dir[p->z]), error = 0.0;
    if (axis == 2)
        return (struct number){1.0, 0.0};
    int of = axis == 0 ? p->x : p->y;
    error = ROUNDING * fabs(p->shear[axis]) +
            (p->dir_error[of] + fabs(p->shear[axis]) * p->dir_error[p->z]) / dz;
    return (struct number){p->shear[axis], error};
}

/* Computes the middle of the chord, and how far its line is from the sphere's centre. `c`: the
   centre seen from the ray's origin; `d`: the ray's direction, 1 along its dominant axis. */
static void chord_measure(const struct number c[3], const struct number d[3], double radius,
                          struct chord *out)
{
    double dd = 0.0, dd_error = 0.0, cd = 0.0, cd_error = 0.0, off2 = 0.0, error = 0.0, along = 0.0;
    for (int i = 0; i < 3; ++i) {
        dd += d[i].value * d[i].value;
        dd_error += 2.0 * fabs(d[i].value) * d[i].error;
        cd += c[i].value * d[i].value;
        cd_error += fabs(d[i].value) * c[i].error + fabs(c[i].value) * d[i].error +
                    3.0 * ROUNDING * fabs(c[i].value * d[i].value);
    }
    dd_error += 3.0 * ROUNDING * dd;
    double middle = cd / dd;
    double middle_error = (cd_error + fabs(middle) * dd_error) / dd + ROUNDING * fabs(middle);
    for (int i = 0; i < 3; ++i) {
        double off = c[i].value - middle * d[i].value;
        double e = c[i].error + fabs(middle) * d[i].error +
                   ROUNDING * (fabs(middle * d[i].value) + fabs(off));
        off2 += off * off;
        error += 2.0 * fabs(off) * e;
        along += (e + middle_error * fabs(d[i].value)) * (e + middle_error * fabs(d[i].value));
    }
    double room = radius * radius - off2;
    out->room = room;
    out->room_error = error + along + 3.0 * ROUNDING * off2 +
                      ROUNDING * (radius * radius + fabs(room)) + DENORMAL;
    out->length_squared = (struct number){dd, dd_error};
    out->middle = (struct number){middle, middle_error};
}

static void chord_ends(const struct number c[3], double radius, struct chord *out)
{
    double dd = out->length_squared.value, dd_error = out->length_squared.error;
    double half = sqrt(fmax(out->room, 0.0) / dd);
    double max = sqrt(fmax(out->room + out->room_error, 0.0) / (dd - dd_error));
    double min = sqrt(fmax(out->room - out->room_error, 0.0) / (dd + dd_error));
    double half_error = fmax(max - half, half - min) + 2.0 * ROUNDING * max;
    double middle = out->middle.value;
    struct number farther = {middle < 0.0 ? middle - half : middle + half, 0.0};
    farther.error = out->middle.error + half_error + ROUNDING * fabs(farther.value);
    double cc = 0.0, product_error = ROUNDING * radius * radius;
    for (int i = 0; i < 3; ++i) {
        cc += c[i].value * c[i].value;
        product_error += c[i].error * (2.0 * fabs(c[i].value) + c[i].error);
    }
    double product = cc - radius * radius;
    product_error += 3.0 * ROUNDING * cc + ROUNDING * fabs(product) + DENORMAL;
    double below = dd * fabs(farther.value);
    double below_error = dd * farther.error + fabs(farther.value) * dd_error + ROUNDING * below;
    struct number nearer = {below > 0.0 ? product / (dd * farther.value) : 0.0, INFINITY};
    if (below > below_error)
        nearer.error = (product_error + fabs(nearer.value) * below_error) / (below - below_error) +
                       ROUNDING * fabs(nearer.value);
    out->half = (struct number){half, half_error};
    out->begin = middle < 0.0 ? farther : nearer;
    out->end = middle < 0.0 ? nearer : farther;
}

/* Converts a distance along the dominant axis to the ray parameter t. */
static struct number chord_t(const struct probe *p, struct number along)
{
    double dz = fabs(p->dir[p->z]);
    struct number t = {along.value / p->dir[p->z], 0.0};
    t.error =
        along.error / dz + fabs(t.value) * (8.0 * ROUNDING + p->dir_error[p->z] / dz) + DENORMAL;
    return t;
}

/* Maps the normal to (u, v) as square_from_dir in shaders/lib/sphere.glsl does. */
static void chord_square(const struct probe *p, const double normal[3], double *u, double *v)
{
    double n[3];
    n[p->x] = normal[0];
    n[p->y] = normal[1];
    n[p->z] = normal[2];
    double size = fabs(n[0]) + fabs(n[1]) + fabs(n[2]);
    double x = n[0] / size, z = n[2] / size;
    bool below = n[1] < 0.0;
    *u = 0.5 + 0.5 * (below ? copysign(1.0 - fabs(z), x) : x);
    *v = 0.5 + 0.5 * (below ? copysign(1.0 - fabs(x), z) : z);
}

/* Tests a sphere; the hit is the first end of the chord at t_min or later. */
static struct verdict probe_sphere(const struct probe *p, const struct gpu_triangle *sphere)
{
    const int axes[3] = {p->x, p->y, p->z};
    double radius = (double)sphere->v1[0];
    struct number c[3], d[3];
    for (int i = 0; i < 3; ++i) {
        c[i].value = (double)sphere->v0[axes[i]] - p->origin[axes[i]];
        c[i].error = ROUNDING * fabs(c[i].value) + p->origin_error[axes[i]];
        d[i] = number_of_axis(p, i);
    }
    struct chord chord;
    chord_measure(c, d, radius, &chord);
    chord_ends(c, radius, &chord);
    bool down = p->dir[p->z] < 0.0;
    struct number enter = chord_t(p, down ? chord.end : chord.begin);
    struct number leave = chord_t(p, down ? chord.begin : chord.end);
    bool at_exit = !(enter.value >= p->t_min);
    struct number t = at_exit ? leave : enter;
    struct verdict out = {.hit = chord.room >= 0.0, .t = t.value, .t_error = t.error};
    out.margin = fabs(chord.room) / chord.room_error;
    out.choice = fabs(enter.value - p->t_min) / enter.error;
    double along = (at_exit != down ? 1.0 : -1.0) * chord.half.value, normal[3];
    for (int i = 0; i < 3; ++i)
        normal[i] = d[i].value * (chord.middle.value + along) - c[i].value;
    chord_square(p, normal, &out.u, &out.v);
    return out;
}

/* ---- Every triangle that matters ---- */

struct search {
    struct conservative_walk walk; /* must come first: callbacks cast it to struct search */
    struct probe world, probe;
    /* Found in the first pass: the two nearest hits. */
    struct verdict best;
    uint32_t instance, primitive;
    double second_t;
    /* Found in the second pass: how many error bounds away another answer is. */
    bool judging;
    double margin;
};

static double outside(double t, double t_error, const struct probe *p)
{
    double off = fmax(p->t_min - t, t - p->t_max);
    return off > 0.0 ? off / t_error : 0.0;
}

static void keep_nearest(struct search *s, const struct verdict *v, uint32_t instance,
                         uint32_t primitive)
{
    if (instance == s->instance && primitive == s->primitive)
        return; /* another record of the same primitive */
    if (hit_comes_before((struct hit_place){v->t, instance, primitive},
                         (struct hit_place){s->best.t, s->instance, s->primitive})) {
        s->second_t = s->primitive == HIT_NONE ? INFINITY : s->best.t;
        s->best = *v;
        s->instance = instance;
        s->primitive = primitive;
    } else if (v->t < s->second_t) {
        s->second_t = v->t;
    }
    s->walk.limit = fmin(s->walk.limit, s->second_t);
}

/* Lowers s->margin by what one primitive may change. The float answer differs only if the nearest
   hit is lost, or if another primitive is hit, within the interval, and in front: all three must
   happen, so the largest of the three margins counts. */
static void judge(struct search *s, const struct verdict *v, const struct probe *p,
                  uint32_t instance, uint32_t primitive)
{
    double margin = v->margin;
    if (instance == s->instance && primitive == s->primitive) {
        margin = fmin(margin, (v->t - p->t_min) / v->t_error);
        margin = fmin(margin, (p->t_max - v->t) / v->t_error);
        margin = fmin(margin, v->choice);
    } else {
        margin = fmax(v->hit ? 0.0 : margin, outside(v->t, v->t_error, p));
        if (s->primitive != HIT_NONE)
            margin = fmax(margin, (v->t - s->best.t) / (v->t_error + s->best.t_error));
        margin = fmin(margin, v->hit ? v->choice : INFINITY);
    }
    s->margin = fmin(s->margin, margin);
}

static struct conservative_ray probe_ray(const struct probe *p)
{
    struct conservative_ray ray = {.t_min = p->t_min,
                                   .t_max = p->t_max,
                                   .growth = p->box_growth,
                                   .margin = 16.0 * p->origin_error_largest};
    memcpy(ray.origin, p->origin, sizeof ray.origin);
    memcpy(ray.dir, p->dir, sizeof ray.dir);
    return ray;
}

static bool enter_instance(struct conservative_walk *walk, uint32_t instance)
{
    struct search *s = (struct search *)walk;
    s->probe = probe_local(&s->world, &walk->accel->instances[instance]);
    walk->ray = probe_ray(&s->probe);
    return true;
}

static void visit_record(struct conservative_walk *walk, uint32_t record, uint32_t instance)
{
    struct search *s = (struct search *)walk;
    const struct gpu_triangle *triangle = &walk->accel->triangles[record];
    const struct probe *p = &s->probe;
    /* Triangles seen edge-on have no meaningful t, but outside of their boxes they are not hit. */
    struct bvh_box box = accel_record_box(triangle);
    if (s->judging && conservative_entry(walk, box.lo, box.hi) == INFINITY)
        return;
    struct verdict v =
        triangle->flags & TRIANGLE_SPHERE ? probe_sphere(p, triangle) : probe_triangle(p, triangle);
    if (s->judging)
        judge(s, &v, p, instance, triangle->primitive);
    else if (v.hit && v.t >= p->t_min && v.t <= p->t_max)
        keep_nearest(s, &v, instance, triangle->primitive);
}

/* In the tree over instances transforms stretch these roundings, by at most |M| |M^-1|: traversals
   widen boxes by 16 of them, of which the box of node 1 has the factors (accel/pose.c). */
static double instance_growth(const struct accel *accel)
{
    double growth = BOX_GROWTH;
    if (accel->single_identity || accel->flat || accel->instance_node_count == 0)
        return growth;
    const struct gpu_bvh_node *slack = &accel->nodes[1];
    for (int i = 0; i < 3; ++i)
        growth = fmax(growth, 4.0 * ((double)slack->lo[i] + (double)slack->hi[i]));
    return growth;
}

void oracle_trace(const struct accel *accel, const struct gpu_ray *ray, bool brute,
                  struct oracle_hit *hit)
{
    *hit = (struct oracle_hit){.t = INFINITY,
                               .primitive = HIT_NONE,
                               .instance = HIT_NONE,
                               .edge_margin = -INFINITY,
                               .second_t = INFINITY};
    if (!accel_ray_is_usable(ray))
        return;
    struct search s = {.walk = {.accel = accel,
                                .brute = brute,
                                .limit = INFINITY,
                                .enter = enter_instance,
                                .visit = visit_record},
                       .best = {.t = INFINITY},
                       .instance = HIT_NONE,
                       .primitive = HIT_NONE,
                       .second_t = INFINITY,
                       .margin = INFINITY};
    s.world = probe_world(ray, brute ? BOX_GROWTH : instance_growth(accel));
    if (!(s.world.t_min <= s.world.t_max))
        return;
    s.probe = s.world;
    s.walk.ray = probe_ray(&s.world);
    conservative_walk_run(&s.walk);
    s.judging = true;
    s.walk.limit = s.primitive == HIT_NONE ? INFINITY : s.best.t + 2.0 * s.best.t_error;
    conservative_walk_run(&s.walk);
    hit->second_t = s.second_t;
    hit->edge_margin = s.primitive == HIT_NONE ? -s.margin : s.margin;
    if (s.primitive == HIT_NONE)
        return;
    hit->t = s.best.t;
    hit->u = s.best.u;
    hit->v = s.best.v;
    hit->t_error = s.best.t_error;
    hit->primitive = s.primitive;
    hit->instance = s.instance;
}

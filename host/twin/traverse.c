/* shaders/bind/traverse.glsl, with the files that it includes, in C: the modes that depend on
   geometry alone. */
#include "accel/accel.h"

#include <float.h>
#include <string.h>

#include "accel/extent.h"
#include "accel/hit_order.h"
#include "twin/exact.h"
#include "twin/exact_sphere.h"
#include "twin/ff_sphere.h"
#include "twin/ff_triangle.h"
#include "twin/intersect.h"
#include "twin/moller.h"
#include "twin/ray.h"
#include "twin/traverse.h"

#define REF_DONE          0xffffffffu
#define REF_ONE_PRIMITIVE (1u << BVH_COUNT_SHIFT)
#define NEAR_SHARE        (1.0f / 524288.0f)
#define NEAR_MIN          0x1p-144f /* the float that has the bits NEAR_STEPS */
enum { STACK_SIZE = 512, NEAR_STEPS = 32 };

struct walk {
    const struct accel *accel;
    const struct gpu_ray *ray; /* world space */
    uint32_t order, numerics;
    bool any;
    bool next;               /* TRAVERSE_NEXT */
    float t_min, hit_before; /* hit_before: -infinity except with TRAVERSE_NEXT */
    uint32_t skip_instance, skip_primitive;
    struct gpu_hit *hit; /* its t is the largest that still counts */
    float lo, hi;        /* bounds of the hit's key */
    bool at_exit;        /* the hit is the far end of a sphere */
    uint32_t triangle;   /* record of the hit */
    struct gpu_cost cost;
    uint32_t status;
    uint32_t level; /* of the current ref */
    uint32_t stack[STACK_SIZE], levels[STACK_SIZE];
};

static bool is_inner(uint32_t ref)
{
    return ref < REF_ONE_PRIMITIVE;
}

static bool is_leaf(uint32_t ref)
{
    return ref - REF_ONE_PRIMITIVE < REF_DONE - REF_ONE_PRIMITIVE;
}

static void push_ref(struct walk *walk, uint32_t ref, uint32_t *top)
{
    if (*top == STACK_SIZE) {
        walk->status |= STATUS_NODE_STACK_OVERFLOW;
        return;
    }
    walk->stack[*top] = ref;
    walk->levels[(*top)++] = walk->level;
    if (*top > walk->cost.stack)
        walk->cost.stack = *top;
}

static uint32_t pop_ref(struct walk *walk, uint32_t base, uint32_t *top)
{
    if (*top == base)
        return REF_DONE;
    walk->level = walk->levels[--*top];
    return walk->stack[*top];
}

static bool enters(const struct walk *walk, float near, float far, float share)
{
    if (walk->numerics == NUMERICS_EXACT) {
        uint32_t bits;
        memcpy(&bits, &near, sizeof bits);
        bits -= NEAR_STEPS;
        memcpy(&near, &bits, sizeof near);
    }
    if (walk->numerics == NUMERICS_WATERTIGHT && share != 0.0f) {
        float less = fabsf(near) * share; /* rounded to float, as in the shader */
        near = near - less;
    }
    return near <= far && near <= walk->hi;
}

static uint32_t step_siblings(struct walk *walk, const struct ray_setup *ray, float near_share,
                              uint32_t pair, uint32_t skip, uint32_t base, uint32_t *top)
{
    const struct gpu_bvh_node *a = &walk->accel->nodes[pair], *b = a + 1;
    float a_near, a_far, b_near, b_far, t_min = walk->t_min;
    if (walk->numerics == NUMERICS_EXACT && t_min < NEAR_MIN)
        t_min = NEAR_MIN;
    slab_interval(ray, vec3_sub(vec3_load(a->lo), ray->above),
                  vec3_sub(vec3_load(a->hi), ray->below), t_min, &a_near, &a_far);
    slab_interval(ray, vec3_sub(vec3_load(b->lo), ray->above),
                  vec3_sub(vec3_load(b->hi), ray->below), t_min, &b_near, &b_far);
    ++walk->level;
    ++walk->cost.inner_nodes;
    if (walk->level > walk->cost.depth)
        walk->cost.depth = walk->level;
    uint32_t ref_a = accel_node_ref(a), ref_b = accel_node_ref(b);
    bool hit_a = enters(walk, a_near, a_far, near_share) && (skip == REF_DONE || ref_a != skip);
    bool hit_b = enters(walk, b_near, b_far, near_share) && (skip == REF_DONE || ref_b != skip);
    bool b_nearer = b_near < a_near;
    if (walk->order == ORDER_SIGN)
        b_nearer = ray->negative[a->count >> BVH_AXIS_SHIFT & BVH_AXIS_MASK] !=
                   ((a->count & BVH_SECOND_LOW) != 0);
    if (walk->order == ORDER_BASIC)
        b_nearer = false;
    bool b_first = hit_b && (!hit_a || b_nearer);
    if (hit_a && hit_b)
        push_ref(walk, b_first ? ref_a : ref_b, top);
    if (!hit_a && !hit_b)
        return pop_ref(walk, base, top);
    return b_first ? ref_b : ref_a;
}

/* A candidate hit. It is compared by its key, which lies in lo..hi: t itself, but at NUMERICS_EXACT
   the exact t rounded to nearest, which becomes the t of a finished hit. */
struct candidate {
    bool met; /* unless `sure`: it may be hit */
    float t, u, v;
    float lo, hi;
    bool sure, rounded; /* NUMERICS_EXACT: it is hit, at t_min or later; t, u and v are valid */
    bool at_exit;       /* the far end of a sphere */
};

static struct candidate meet_triangle(const struct walk *walk, const struct ray_setup *ray,
                                      const struct gpu_triangle *triangle)
{
    struct vec3 v0 = vec3_load(triangle->v0), v1 = vec3_load(triangle->v1),
                v2 = vec3_load(triangle->v2);
    struct vec3 a = vec3_sub(v0, ray->origin), b = vec3_sub(v1, ray->origin),
                c = vec3_sub(v2, ray->origin);
    struct candidate m = {.at_exit = false};
    if (walk->numerics == NUMERICS_EXACT) {
        struct exact_bounds bounds;
        exact_filter(ray, a, b, c, &bounds);
        return (struct candidate){.met = !bounds.outside && !(bounds.hi < walk->t_min),
                                  .t = bounds.t > walk->t_min ? bounds.t : walk->t_min,
                                  .u = bounds.u,
                                  .v = bounds.v,
                                  .lo = bounds.lo,
                                  .hi = bounds.hi,
                                  .sure = bounds.inside && bounds.lo >= walk->t_min,
                                  .rounded = bounds.inside};
    }
    if (walk->numerics == NUMERICS_FAST)
        m.met = intersect_moller(ray->origin, ray->dir, v0, v1, v2, walk->t_min, &m.t, &m.u, &m.v);
    else
        m.met = intersect_triangle(ray, a, b, c, walk->t_min, &m.t, &m.u, &m.v);
    m.lo = m.hi = m.t;
    return m;
}

/* The candidate hit at one end of a chord. `self`: the ray starts on the sphere, and hits it again
   only if it goes inwards. */
static struct candidate meet_end(const struct walk *walk, const struct ray_setup *ray,
                                 const struct chord *chord, const struct sphere_bounds *bounds,
                                 bool at_exit, bool self)
{
    float at = at_exit ? chord->t_far : chord->t_near;
    struct candidate m = {.t = at > chord->t_box ? at : chord->t_box, .at_exit = at_exit};
    square_from_dir(chord_end(ray, chord, at_exit), &m.u, &m.v);
    m.met = chord->met && at >= walk->t_min && (!self || chord->inward);
    m.lo = m.hi = m.t;
    if (walk->numerics == NUMERICS_EXACT) {
        bool end_known = at_exit || bounds->near_lo >= walk->t_min;
        m.lo = at_exit ? bounds->far_lo : bounds->near_lo;
        m.hi = at_exit || !end_known ? bounds->far_hi : bounds->near_hi;
        m.met = !bounds->outside && !(self && bounds->inward_known && !chord->inward) &&
                !(m.hi < walk->t_min);
        m.rounded = bounds->inside && end_known;
        m.sure = m.rounded && m.lo >= walk->t_min && (!self || bounds->inward_known);
    }
    return m;
}

/* ---- NUMERICS_EXACT ---- */

static struct ray_setup ray_at(const struct walk *walk, uint32_t instance);

/* Finds exactly where a triangle is hit. `hit`: it is known to be; only the key is wanted. */
static void meet_exactly(const struct ray_setup *ray, const struct gpu_triangle *triangle, bool hit,
                         struct exact_candidate *out)
{
    struct vec3 v0 = vec3_load(triangle->v0), v1 = vec3_load(triangle->v1),
                v2 = vec3_load(triangle->v2);
    bool key_known;
    bool known = ff_meet(ray->origin, ray->dir, v0, v1, v2, out, &key_known);
    if (!(hit ? key_known : known))
        exact_meet(ray->origin, ray->dir, v0, v1, v2, out);
}

static void meet_sphere_exactly(const struct ray_setup *ray, const struct gpu_triangle *sphere,
                                bool only_far, float t_min, struct sphere_candidate *out)
{
    struct vec3 center = vec3_load(sphere->v0);
    float radius = sphere->v1[0];
    if (!ff_meet_sphere(ray->origin, ray->dir, center, radius, only_far, t_min, out))
        exact_meet_sphere(ray->origin, ray->dir, center, radius, only_far, t_min, out);
}

/* Computes the key of the hit so far, of which only bounds are known. */
static void settle_hit(struct walk *walk)
{
    struct ray_setup ray = ray_at(walk, walk->hit->instance);
    const struct gpu_triangle *record = &walk->accel->triangles[walk->triangle];
    struct exact_candidate m;
    struct sphere_candidate on_sphere;
    if (record->flags & TRIANGLE_SPHERE) {
        meet_sphere_exactly(&ray, record, walk->at_exit, 0.0f, &on_sphere);
        m.key = on_sphere.key;
    } else {
        meet_exactly(&ray, record, true, &m);
    }
    walk->lo = m.key;
    walk->hi = m.key;
    walk->hit->t = m.key;
}

/* Replaces the bounds of a candidate by the exact result; also finds the key of the hit so far
   where only both tell which comes first. */
static void settle(struct walk *walk, const struct ray_setup *ray,
                   const struct gpu_triangle *record, bool self, struct candidate *m)
{
    if (record->flags & TRIANGLE_SPHERE) {
        struct sphere_candidate exact;
        meet_sphere_exactly(ray, record, m->at_exit, walk->t_min, &exact);
        struct vec3 to_center = vec3_sub(vec3_load(record->v0), ray->origin);
        if (!m->rounded || exact.at_exit != m->at_exit)
            square_from_dir(vec3_sub(vec3_scale(ray->dir, exact.key), to_center), &m->u, &m->v);
        m->met = exact.met && (!self || exact.inward);
        m->at_exit = exact.at_exit;
        m->t = exact.key;
    } else {
        struct exact_candidate exact;
        meet_exactly(ray, record, false, &exact);
        m->met = exact.met && exact.key >= walk->t_min;
        m->u = m->rounded ? m->u : exact.u;
        m->v = m->rounded ? m->v : exact.v;
        m->t = exact.key;
    }
    m->lo = m->hi = m->t;
    if (m->met && m->t >= walk->lo && m->t <= walk->hi && walk->lo < walk->hi)
        settle_hit(walk);
}

/* ---- Which candidate is the hit ---- */

/* Whether a candidate is hit, comes before the hit so far, and comes behind the known hit; unless
   both keys are known, whether that is possible. */
static bool is_reached(const struct walk *walk, const struct candidate *m, uint32_t instance,
                       uint32_t primitive)
{
    const struct hit_place lo = {(double)m->lo, instance, primitive};
    const struct hit_place hi = {(double)m->hi, instance, primitive};
    const struct hit_place so_far = {(double)walk->hi, walk->hit->instance, walk->hit->primitive};
    const struct hit_place known = {(double)walk->hit_before, walk->skip_instance,
                                    walk->skip_primitive};
    return m->met && hit_comes_before(lo, so_far) && (!walk->next || hit_comes_before(known, hi));
}

static bool accept_candidate(struct walk *walk, const struct ray_setup *ray, struct candidate *m,
                             uint32_t record, uint32_t instance, bool self)
{
    const struct gpu_triangle *triangle = &walk->accel->triangles[record];
    if (!is_reached(walk, m, instance, triangle->primitive))
        return false;
    bool sure = m->sure && m->hi < walk->lo && m->lo > walk->hit_before;
    if (walk->numerics == NUMERICS_EXACT && !sure) {
        settle(walk, ray, triangle, self, m);
        if (!is_reached(walk, m, instance, triangle->primitive))
            return false;
    }
    walk->lo = m->lo;
    walk->hi = m->hi;
    walk->at_exit = m->at_exit;
    walk->hit->t = m->t;
    walk->hit->u = m->u;
    walk->hit->v = m->v;
    walk->hit->primitive = triangle->primitive;
    walk->hit->instance = instance;
    walk->triangle = record;
    return true;
}

static bool test_sphere(struct walk *walk, const struct ray_setup *ray, uint32_t record,
                        uint32_t instance, bool self)
{
    const struct gpu_triangle *sphere = &walk->accel->triangles[record];
    struct vec3 center = vec3_load(sphere->v0);
    struct chord chord = intersect_sphere(ray, center, sphere->v1[0], walk->t_min);
    struct sphere_bounds bounds;
    bool at_exit = self || !(chord.t_near >= walk->t_min);
    if (walk->numerics == NUMERICS_EXACT) {
        bound_sphere(ray, center, sphere->v1[0], &bounds);
        at_exit = self || bounds.near_hi < walk->t_min;
    }
    struct candidate m = meet_end(walk, ray, &chord, &bounds, at_exit, self);
    bool accepted = accept_candidate(walk, ray, &m, record, instance, self);
    if (walk->next && !accepted && !m.at_exit) {
        m = meet_end(walk, ray, &chord, &bounds, true, self);
        accepted = accept_candidate(walk, ray, &m, record, instance, self);
    }
    return accepted;
}

static bool test_record(struct walk *walk, const struct ray_setup *ray, uint32_t record,
                        uint32_t instance)
{
    const struct gpu_triangle *triangle = &walk->accel->triangles[record];
    ++walk->cost.triangles;
    if (walk->accel->flat)
        instance = triangle->flags >> TRIANGLE_INSTANCE_SHIFT;
    bool self = !walk->next && instance == walk->skip_instance &&
                (triangle->primitive == walk->skip_primitive || walk->skip_primitive == SKIP_ALL);
    if (triangle->flags & TRIANGLE_SPHERE)
        return test_sphere(walk, ray, record, instance, self) && walk->any;
    if (self)
        return false;
    struct candidate m = meet_triangle(walk, ray, triangle);
    return accept_candidate(walk, ray, &m, record, instance, false) && walk->any;
}

static void traverse_mesh(struct walk *walk, const struct ray_setup *ray, uint32_t root,
                          uint32_t base, uint32_t instance)
{
    uint32_t top = base, ref = root;
    while (ref != REF_DONE) {
        while (is_inner(ref))
            ref = step_siblings(walk, ray, 0.0f, ref, REF_DONE, base, &top);
        while (is_leaf(ref)) {
            bool done = test_record(walk, ray, ref & BVH_FIRST_MASK, instance);
            ref += 1u - REF_ONE_PRIMITIVE;
            if (is_inner(ref) || done)
                ++walk->cost.leaves;
            if (is_inner(ref))
                ref = pop_ref(walk, base, &top);
            if (done)
                ref = REF_DONE;
        }
    }
}

static void widen(const struct accel *accel, const struct gpu_instance *i, struct ray_setup *ray)
{
    if (accel->clipped)
        widen_ray_setup(ray, vec3_make(i->center_x, i->center_y, i->center_z), i->reach);
}

static struct ray_setup setup_ray(const struct walk *walk, struct vec3 origin, struct vec3 dir)
{
    struct ray_setup ray = make_ray_setup(origin, dir);
    if (walk->numerics == NUMERICS_FAST)
        ray.far_scale = 1.0f;
    if (walk->numerics == NUMERICS_EXACT)
        bound_ray_setup(&ray);
    return ray;
}

static struct ray_setup world_ray(const struct walk *walk)
{
    return setup_ray(walk, vec3_load(walk->ray->origin), vec3_load(walk->ray->dir));
}

static struct ray_setup local_ray(const struct walk *walk, const struct gpu_instance *instance)
{
    struct gpu_ray local = accel_local_ray(instance, walk->ray);
    return setup_ray(walk, vec3_load(local.origin), vec3_load(local.dir));
}

/* Whether there is only one tree, in world space: rays need no transform. */
static bool one_tree(const struct accel *accel)
{
    return accel->single_identity || accel->flat;
}

static struct ray_setup ray_at(const struct walk *walk, uint32_t instance)
{
    return one_tree(walk->accel) ? world_ray(walk)
                                 : local_ray(walk, &walk->accel->instances[instance]);
}

static void traverse_instances(struct walk *walk, uint32_t root)
{
    struct ray_setup world = world_ray(walk);
    const struct gpu_bvh_node *slack = &walk->accel->nodes[1];
    widen_world_setup(&world, vec3_load(slack->lo), vec3_load(slack->hi));
    uint32_t skip =
        walk->skip_primitive == SKIP_ALL ? REF_ONE_PRIMITIVE | walk->skip_instance : REF_DONE;
    uint32_t top = 0, ref = root == skip ? REF_DONE : root;
    while (ref != REF_DONE) {
        while (is_inner(ref))
            ref = step_siblings(walk, &world, NEAR_SHARE, ref, skip, 0, &top);
        if (is_leaf(ref)) {
            uint32_t index = ref & BVH_FIRST_MASK;
            const struct gpu_instance *instance = &walk->accel->instances[index];
            struct ray_setup local = local_ray(walk, instance);
            widen(walk->accel, instance, &local);
            ++walk->cost.instances;
            uint32_t level = walk->level;
            traverse_mesh(walk, &local, instance->root, top, index);
            walk->level = level;
            bool done = walk->any && walk->hit->primitive != HIT_NONE;
            ref = done ? REF_DONE : pop_ref(walk, 0, &top);
        }
    }
}

/* Sets the geometric normal, (v1 - v0) x (v2 - v0) or that of a sphere, transformed to world space
   by the inverse transpose. */
static void set_normal(struct gpu_hit *hit, const struct accel *accel, uint32_t record)
{
    const struct gpu_triangle *triangle = &accel->triangles[record];
    struct vec3 v0 = vec3_load(triangle->v0);
    struct vec3 n =
        vec3_cross(vec3_sub(vec3_load(triangle->v1), v0), vec3_sub(vec3_load(triangle->v2), v0));
    if (triangle->flags & TRIANGLE_SPHERE)
        n = dir_from_square(hit->u, hit->v);
    if (triangle->flags & TRIANGLE_MIRRORED && accel->flat)
        n = vec3_make(-n.x, -n.y, -n.z);
    if (!accel->single_identity && !accel->flat) {
        const struct gpu_instance *i = &accel->instances[hit->instance];
        const float *r0 = i->inverse0, *r1 = i->inverse1, *r2 = i->inverse2;
        n = accel_rotate_rows((float[]){r0[0], r1[0], r2[0]}, (float[]){r0[1], r1[1], r2[1]},
                              (float[]){r0[2], r1[2], r2[2]}, n);
    }
    hit->ng_x = n.x;
    hit->ng_y = n.y;
    hit->ng_z = n.z;
}

static void add_cost(const struct gpu_cost *from, struct gpu_cost *to)
{
    to->rays += from->rays;
    to->inner_nodes += from->inner_nodes;
    to->leaves += from->leaves;
    to->instances += from->instances;
    to->triangles += from->triangles;
    to->stack = from->stack > to->stack ? from->stack : to->stack;
    to->depth = from->depth > to->depth ? from->depth : to->depth;
}

static void traverse_trees(struct walk *walk)
{
    const struct accel *accel = walk->accel;
    if (!one_tree(accel)) {
        traverse_instances(walk, accel->instance_root);
        return;
    }
    struct ray_setup setup = world_ray(walk);
    uint32_t root = accel->flat ? accel->meshes[0].root : accel->instances[0].root;
    if (root == BVH_EMPTY_REF)
        return;
    widen(accel, &accel->instances[0], &setup);
    traverse_mesh(walk, &setup, root, 0, 0);
}

/* Tests every record of every instance, in order. */
static void traverse_records(struct walk *walk)
{
    const struct accel *accel = walk->accel;
    bool done = false;
    for (uint32_t i = 0; !done && i < (accel->flat ? 1 : accel->instance_count); ++i) {
        const struct accel_mesh *mesh = &accel->meshes[accel->flat ? 0 : accel->instances[i].mesh];
        struct ray_setup setup = ray_at(walk, i);
        walk->cost.instances += !one_tree(accel) && mesh->record_count > 0;
        for (uint32_t k = 0; !done && k < mesh->record_count; ++k)
            done = test_record(walk, &setup, mesh->first_triangle + k, i);
    }
}

static void begin_walk(struct walk *walk, const struct accel *accel,
                       const struct traverse_params *params, const struct gpu_ray *ray,
                       struct gpu_hit *hit)
{
    const struct gpu_hit none = {.primitive = HIT_NONE, .instance = HIT_NONE};
    const struct gpu_hit *left_out = params->own ? params->own : &none;
    walk->accel = accel;
    walk->ray = ray;
    walk->order = params->order;
    walk->numerics = params->numerics;
    walk->any = params->any;
    walk->next = params->behind != NULL;
    left_out = walk->next ? params->behind : left_out;
    walk->hit_before = walk->next ? left_out->t : -INFINITY;
    walk->skip_instance = left_out->instance;
    walk->skip_primitive = left_out->primitive;
    walk->t_min = ray->t_min;
    if (params->numerics == NUMERICS_EXACT && ray->t_min < 0.0f)
        walk->t_min = 0.0f;
    walk->hit = hit;
    walk->triangle = 0;
    walk->level = 0;
    walk->cost = (struct gpu_cost){.rays = 1};
    walk->status = 0;
    *hit = none;
    hit->t = ray->t_max < FLT_MAX ? ray->t_max : FLT_MAX;
    walk->at_exit = false;
    walk->lo = hit->t;
    walk->hi = hit->t;
}

void traverse_ray(const struct accel *accel, const struct traverse_params *params,
                  const struct gpu_ray *ray, struct gpu_hit *hit, struct gpu_cost *cost,
                  uint32_t *status)
{
    static const struct traverse_params closest;
    struct walk walk;
    params = params ? params : &closest;
    begin_walk(&walk, accel, params, ray, hit);
    if (accel_ray_is_usable(ray)) {
        if (params->brute)
            traverse_records(&walk);
        else
            traverse_trees(&walk);
        if (walk.numerics == NUMERICS_EXACT && !walk.any && walk.lo < walk.hi)
            settle_hit(&walk);
    }
    if (hit->primitive == HIT_NONE)
        hit->t = INFINITY;
    else
        set_normal(hit, accel, walk.triangle);
    if (cost)
        add_cost(&walk.cost, cost);
    *status |= walk.status;
}

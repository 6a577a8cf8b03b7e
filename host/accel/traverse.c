/* shaders/bind/traverse.glsl in C, for the two modes that geometry alone decides. */
#include "accel/accel_inside.h"

#include <float.h>

#include "accel/intersect.h"

#define REF_DONE                  0xffffffffu
#define REF_ONE_PRIMITIVE         (1u << BVH_COUNT_SHIFT)
/* As in the shader; the product is rounded to float there too. */
#define SLAB_NEAR_SCALE_INSTANCES (1.0f - 1.0f / 524288.0f)
enum { STACK_SIZE = 512 };

struct walk {
    const struct accel *accel;
    uint32_t order;
    bool any;
    float t_min;
    uint32_t skip_instance, skip_primitive;
    struct gpu_hit *hit; /* t is the largest that still counts */
    uint32_t triangle;   /* record of the hit */
    struct gpu_cost cost;
    uint32_t status;
    uint32_t stack[STACK_SIZE];
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
    walk->stack[(*top)++] = ref;
    if (*top > walk->cost.stack)
        walk->cost.stack = *top;
}

static uint32_t pop_ref(struct walk *walk, uint32_t base, uint32_t *top)
{
    return *top == base ? REF_DONE : walk->stack[--*top];
}

static uint32_t step_pair(struct walk *walk, const struct ray_setup *ray, float near_scale,
                          uint32_t pair, uint32_t base, uint32_t *top)
{
    const struct gpu_bvh_node *a = &walk->accel->nodes[pair], *b = a + 1;
    float a_near, a_far, b_near, b_far;
    slab_interval(ray, vec3_sub(vec3_load(a->lo), ray->origin),
                  vec3_sub(vec3_load(a->hi), ray->origin), walk->t_min, &a_near, &a_far);
    slab_interval(ray, vec3_sub(vec3_load(b->lo), ray->origin),
                  vec3_sub(vec3_load(b->hi), ray->origin), walk->t_min, &b_near, &b_far);
    if (near_scale != 1.0f) {
        a_near = a_near * near_scale;
        b_near = b_near * near_scale;
    }
    ++walk->cost.pairs;
    float t = walk->hit->t;
    bool hit_a = a_near <= a_far && a_near <= t;
    bool hit_b = b_near <= b_far && b_near <= t;
    uint32_t ref_a = accel_node_ref(a), ref_b = accel_node_ref(b);
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

static bool test_triangle(struct walk *walk, const struct ray_setup *ray, uint32_t record,
                          uint32_t instance)
{
    const struct gpu_triangle *triangle = &walk->accel->triangles[record];
    ++walk->cost.triangles;
    float t, u, v;
    if (!intersect_triangle(ray, vec3_sub(vec3_load(triangle->v0), ray->origin),
                            vec3_sub(vec3_load(triangle->v1), ray->origin),
                            vec3_sub(vec3_load(triangle->v2), ray->origin), walk->t_min, &t, &u,
                            &v))
        return false;
    struct gpu_hit *hit = walk->hit;
    uint32_t primitive = triangle->primitive;
    bool nearer =
        t < hit->t || (t == hit->t && (instance < hit->instance ||
                                       (instance == hit->instance && primitive < hit->primitive)));
    bool skipped = primitive == walk->skip_primitive && instance == walk->skip_instance;
    if (!nearer || skipped)
        return false;
    hit->t = t;
    hit->u = u;
    hit->v = v;
    hit->primitive = primitive;
    hit->instance = instance;
    walk->triangle = record;
    return walk->any;
}

static void traverse_mesh(struct walk *walk, const struct ray_setup *ray, uint32_t root,
                          uint32_t base, uint32_t instance)
{
    uint32_t top = base, ref = root;
    while (ref != REF_DONE) {
        while (is_inner(ref))
            ref = step_pair(walk, ray, 1.0f, ref, base, &top);
        while (is_leaf(ref)) {
            bool done = test_triangle(walk, ray, ref & BVH_FIRST_MASK, instance);
            ref += 1u - REF_ONE_PRIMITIVE;
            if (is_inner(ref))
                ref = pop_ref(walk, base, &top);
            if (done)
                ref = REF_DONE;
        }
    }
}

static struct vec3 rotate_rows(const float *r0, const float *r1, const float *r2, struct vec3 p)
{
    return vec3_make((r0[0] * p.x + r0[1] * p.y) + r0[2] * p.z,
                     (r1[0] * p.x + r1[1] * p.y) + r1[2] * p.z,
                     (r2[0] * p.x + r2[1] * p.y) + r2[2] * p.z);
}

static struct ray_setup local_ray(const struct gpu_instance *instance, const struct gpu_ray *ray)
{
    struct vec3 origin = vec3_make(instance->origin_x, instance->origin_y, instance->origin_z);
    struct vec3 relative = vec3_sub(vec3_load(ray->origin), origin);
    return make_ray_setup(
        rotate_rows(instance->inverse0, instance->inverse1, instance->inverse2, relative),
        rotate_rows(instance->inverse0, instance->inverse1, instance->inverse2,
                    vec3_load(ray->dir)));
}

static void traverse_instances(struct walk *walk, const struct gpu_ray *ray, uint32_t root)
{
    struct ray_setup world = make_ray_setup(vec3_load(ray->origin), vec3_load(ray->dir));
    uint32_t top = 0, ref = root;
    while (ref != REF_DONE) {
        while (is_inner(ref))
            ref = step_pair(walk, &world, SLAB_NEAR_SCALE_INSTANCES, ref, 0, &top);
        if (is_leaf(ref)) {
            uint32_t index = ref & BVH_FIRST_MASK;
            const struct gpu_instance *instance = &walk->accel->instances[index];
            struct ray_setup local = local_ray(instance, ray);
            ++walk->cost.instances;
            traverse_mesh(walk, &local, instance->root, top, index);
            bool done = walk->any && walk->hit->primitive != HIT_NONE;
            ref = done ? REF_DONE : pop_ref(walk, 0, &top);
        }
    }
}

/* (v1 - v0) x (v2 - v0), taken to world space by the inverse transpose. */
static void set_normal(struct gpu_hit *hit, const struct accel *accel, uint32_t record)
{
    const struct gpu_triangle *triangle = &accel->triangles[record];
    struct vec3 v0 = vec3_load(triangle->v0);
    struct vec3 n =
        vec3_cross(vec3_sub(vec3_load(triangle->v1), v0), vec3_sub(vec3_load(triangle->v2), v0));
    if (!accel->single_identity) {
        const struct gpu_instance *i = &accel->instances[hit->instance];
        const float *r0 = i->inverse0, *r1 = i->inverse1, *r2 = i->inverse2;
        n = rotate_rows((float[]){r0[0], r1[0], r2[0]}, (float[]){r0[1], r1[1], r2[1]},
                        (float[]){r0[2], r1[2], r2[2]}, n);
    }
    hit->ng_x = n.x;
    hit->ng_y = n.y;
    hit->ng_z = n.z;
}

static bool ray_is_usable(const struct gpu_ray *ray)
{
    struct vec3 o = vec3_load(ray->origin), d = vec3_load(ray->dir);
    struct vec3 bounded = vec3_add(vec3_sub(o, o), vec3_sub(d, d)); /* 0, or NaN */
    return bounded.x + bounded.y + bounded.z == 0.0f && (d.x != 0.0f || d.y != 0.0f || d.z != 0.0f);
}

static void begin_hit(struct gpu_hit *hit, float t_max)
{
    *hit = (struct gpu_hit){
        .t = t_max < FLT_MAX ? t_max : FLT_MAX, .primitive = HIT_NONE, .instance = HIT_NONE};
}

static void end_hit(struct gpu_hit *hit, const struct accel *accel, uint32_t record)
{
    if (hit->primitive == HIT_NONE)
        hit->t = INFINITY;
    else
        set_normal(hit, accel, record);
}

static void add_cost(const struct gpu_cost *from, struct gpu_cost *to)
{
    to->rays += from->rays;
    to->pairs += from->pairs;
    to->leaves += from->leaves;
    to->instances += from->instances;
    to->triangles += from->triangles;
    to->stack = from->stack > to->stack ? from->stack : to->stack;
    to->depth = from->depth > to->depth ? from->depth : to->depth;
}

void traverse_float(const struct accel *accel, uint32_t order, const struct gpu_ray *ray, bool any,
                    uint32_t skip_instance, uint32_t skip_primitive, struct gpu_hit *hit,
                    struct gpu_cost *cost, uint32_t *status)
{
    struct walk walk;
    walk.accel = accel;
    walk.order = order;
    walk.any = any;
    walk.t_min = ray->t_min;
    walk.skip_instance = skip_instance;
    walk.skip_primitive = skip_primitive;
    walk.hit = hit;
    walk.triangle = 0;
    walk.cost = (struct gpu_cost){.rays = 1};
    walk.status = 0;
    begin_hit(hit, ray->t_max);
    if (ray_is_usable(ray)) {
        if (accel->single_identity) {
            struct ray_setup setup = make_ray_setup(vec3_load(ray->origin), vec3_load(ray->dir));
            traverse_mesh(&walk, &setup, accel->instances[0].root, 0, 0);
        } else {
            traverse_instances(&walk, ray, accel->instance_root);
        }
    }
    end_hit(hit, accel, walk.triangle);
    if (cost)
        add_cost(&walk.cost, cost);
    *status |= walk.status;
}

void traverse_brute_float(const struct accel *accel, const struct gpu_ray *ray, struct gpu_hit *hit)
{
    struct walk walk = {.accel = accel,
                        .t_min = ray->t_min,
                        .skip_instance = HIT_NONE,
                        .skip_primitive = HIT_NONE,
                        .hit = hit};
    begin_hit(hit, ray->t_max);
    for (uint32_t i = 0; ray_is_usable(ray) && i < accel->instance_count; ++i) {
        const struct gpu_instance *instance = &accel->instances[i];
        const struct accel_mesh *mesh = &accel->meshes[instance->mesh];
        struct ray_setup setup = accel->single_identity
                                     ? make_ray_setup(vec3_load(ray->origin), vec3_load(ray->dir))
                                     : local_ray(instance, ray);
        for (uint32_t k = 0; k < mesh->triangle_count; ++k)
            test_triangle(&walk, &setup, mesh->first_triangle + k, i);
    }
    end_hit(hit, accel, walk.triangle);
}

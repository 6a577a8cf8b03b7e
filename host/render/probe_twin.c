/* Hits of the rays of a probed pixel, found on the CPU. It does not read textures: where a surface
   may let a ray pass, the device's answer is taken, and everything else must agree with it. */
#include <math.h>
#include <string.h>

#include "accel/material_bits.h"
#include "accel/pose.h"
#include "oracle/rational.h"
#include "render/probe.h"
#include "render/renderer.h"
#include "twin/traverse.h"

/* Most surfaces that the exact trace of a ray can be told to pass. */
enum { PASSED_MAX = 64 };

struct asking {
    const struct renderer *renderer;
    struct rational *rational;
    struct probe_ray *ray;
    struct gpu_ray line;
    uint32_t passed_instance[PASSED_MAX], passed_primitive[PASSED_MAX];
};

static bool is_shadow(const struct asking *a)
{
    return (a->ray->traced.kind & PROBE_KIND_MASK) == RAY_SHADOW;
}

/* Whether the ray comes from behind or along the surface, where the kernel's test and this one may
   round differently. */
static bool comes_from_behind(const struct gpu_ray *line, const struct gpu_hit *hit)
{
    const float ng[3] = {hit->ng_x, hit->ng_y, hit->ng_z};
    double along = 0.0, size = 0.0;
    for (int i = 0; i < 3; ++i) {
        double product = (double)ng[i] * (double)line->dir[i];
        along += product;
        size += fabs(product);
    }
    return along > -1e-6 * size;
}

/* Whether the material may let the ray go on. Only the device can decide that for a cut-out. */
static bool may_pass(const struct asking *a, const struct gpu_hit *hit)
{
    const struct renderer *renderer = a->renderer;
    const bool *called = renderer->effects.called;
    uint32_t flags = accel_primitive_flags(renderer->accel, hit->instance, hit->primitive);
    if ((flags & TRIANGLE_CUTOUT) && called[SCENE_EFFECT_CUTOUTS])
        return true;
    if (!is_shadow(a))
        return (flags & TRIANGLE_ONE_SIDED) && called[SCENE_EFFECT_CULLING] &&
               comes_from_behind(&a->line, hit);
    return (flags & TRIANGLE_NO_SHADOW) ||
           ((flags & TRIANGLE_FILTER) && called[SCENE_EFFECT_TINTED_SHADOWS]);
}

static void pass(struct asking *a, const struct gpu_hit *hit)
{
    uint32_t at = a->ray->passed++;
    if (at < PASSED_MAX) {
        a->passed_instance[at] = hit->instance;
        a->passed_primitive[at] = hit->primitive;
    }
}

/* Whether the twin passed the surface of `hit`; takes it off the list. A sphere may be passed at
   both of its ends, and is then listed twice. */
static bool take_passed(struct asking *a, const struct rational_hit *hit)
{
    for (uint32_t i = 0; i < a->ray->passed && i < PASSED_MAX; ++i) {
        if (a->passed_instance[i] == hit->instance && a->passed_primitive[i] == hit->primitive) {
            a->passed_primitive[i] = HIT_NONE;
            return true;
        }
    }
    return false;
}

static bool same_bits(float a, float b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

static bool is_device_hit(const struct gpu_probe_ray *traced, const struct gpu_hit *hit)
{
    return traced->primitive == hit->primitive && traced->instance == hit->instance &&
           same_bits(traced->t, hit->t) && same_bits(traced->u, hit->u) &&
           same_bits(traced->v, hit->v);
}

/* Whether the device met the shape of a user's intersect(), which only the device knows. The ray
   then ends there, and the CPU must find nothing before that. */
static bool is_on_shape(const struct gpu_probe_ray *traced)
{
    return traced->instance == HIT_SHAPE;
}

/* Goes through the hits from front to back, until it finds the device's hit or there are no
   more. */
static void ask_twin(struct asking *a)
{
    struct probe_ray *ray = a->ray;
    const struct gpu_probe_ray *traced = &ray->traced;
    const whit_renderer_params *params = &a->renderer->params;
    const struct gpu_hit own = {.instance = traced->skip_instance,
                                .primitive = traced->skip_primitive};
    struct traverse_params walk = {
        .order = (uint32_t)params->traversal, .numerics = params->numerics, .own = &own};
    uint32_t status = 0;
    struct gpu_hit hit, first = {.t = INFINITY, .primitive = HIT_NONE, .instance = HIT_NONE};
    traverse_ray(a->renderer->accel, &walk, &a->line, &hit, NULL, &status);
    while (hit.primitive != HIT_NONE && !is_device_hit(traced, &hit)) {
        bool stops = !may_pass(a, &hit);
        if (stops && first.primitive == HIT_NONE)
            first = hit;
        if (stops && !is_shadow(a))
            break;
        if (first.primitive == HIT_NONE)
            pass(a, &hit);
        walk.behind = &hit;
        traverse_ray(a->renderer->accel, &walk, &a->line, &hit, NULL, &status);
    }
    if (hit.primitive != HIT_NONE && is_device_hit(traced, &hit)) {
        ray->twin = hit;
        ray->equal = true;
    } else {
        ray->twin = first;
        ray->equal =
            first.primitive == HIT_NONE && (traced->primitive == HIT_NONE || is_on_shape(traced));
    }
    ray->equal &= status == 0;
}

static bool exact_agrees(const struct asking *a)
{
    const struct probe_ray *ray = a->ray;
    const struct gpu_probe_ray *traced = &ray->traced;
    bool met = ray->exact_primitive != HIT_NONE;
    if (is_on_shape(traced))
        return !met;
    if (is_shadow(a))
        return met == (traced->end == PROBE_BLOCKED);
    bool exact_t = a->renderer->params.numerics == NUMERICS_EXACT;
    return ray->exact_primitive == traced->primitive && ray->exact_instance == traced->instance &&
           (!exact_t || ray->exact_t == traced->t);
}

static void ask_exactly(struct asking *a)
{
    struct probe_ray *ray = a->ray;
    const struct rational_hit own = {.instance = ray->traced.skip_instance,
                                     .primitive = ray->traced.skip_primitive};
    struct rational_query query = {.own = &own};
    struct rational_hit hit, before;
    if (ray->passed > PASSED_MAX)
        return;
    rational_trace(a->rational, &a->line, &query, &hit);
    while (hit.primitive != HIT_NONE && take_passed(a, &hit)) {
        before = hit;
        query.behind = &before;
        rational_trace(a->rational, &a->line, &query, &hit);
    }
    ray->exact_known = true;
    ray->exact_t = hit.t;
    ray->exact_instance = hit.instance;
    ray->exact_primitive = hit.primitive;
    ray->exact_equal = exact_agrees(a);
}

whit_result probe_ask_twin(const struct renderer *renderer, struct probe_report *report)
{
    struct asking a = {.renderer = renderer};
    whit_result result = accel_pose_again(renderer->accel, &renderer->pose);
    if (result != WHIT_OK)
        return result;
    a.rational = rational_create(renderer->accel);
    if (!a.rational)
        return render_no_memory(renderer, "exact arithmetic");
    for (uint32_t i = 0; i < report->ray_count; ++i) {
        const struct gpu_probe_ray *traced = &report->rays[i].traced;
        a.ray = &report->rays[i];
        a.ray->twin = (struct gpu_hit){.t = INFINITY, .primitive = HIT_NONE, .instance = HIT_NONE};
        a.ray->equal = true;
        if (traced->end == PROBE_DEPTH || traced->end == PROBE_BAILOUT)
            continue;
        a.line = (struct gpu_ray){.t_max = is_on_shape(traced) ? traced->t : traced->t_max};
        memcpy(a.line.origin, traced->origin, sizeof a.line.origin);
        memcpy(a.line.dir, traced->dir, sizeof a.line.dir);
        ask_twin(&a);
        ask_exactly(&a);
        report->differing += !a.ray->equal;
    }
    rational_destroy(a.rational);
    return WHIT_OK;
}

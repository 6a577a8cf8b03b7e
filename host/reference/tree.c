/* Traces the ray tree of a sample (Whitted 1980): each ray adds its light to the sample, and puts
   the rays that its surface calls for on a stack. */
#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "reference/camera.h"
#include "reference/hits.h"
#include "reference/inside.h"
#include "reference/light.h"
#include "reference/lighting.h"
#include "reference/media.h"
#include "reference/optics.h"
#include "reference/surface.h"
#include "reference/tree.h"

/* ---- Keeping the tree ---- */

static void store(struct dvec3 v, double out[3])
{
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

uint32_t tree_record(struct tracer *tracer, const struct reference_ray *ray)
{
    if (!tracer->records)
        return REFERENCE_NONE;
    if (!ARRAY_PUSH(tracer->nodes, tracer->node_count, tracer->node_capacity, *ray)) {
        tracer->lacks_memory = true;
        return REFERENCE_NONE;
    }
    return tracer->node_count - 1;
}

/* Records a ray, with the values that are known before it is traced. */
static uint32_t record_ray(struct tracer *tracer, const struct ray *ray, whit_probe_end end)
{
    struct reference_ray node = {.kind = ray->kind,
                                 .end = end,
                                 .parent = ray->node,
                                 .bounces = ray_bounces(ray->steps),
                                 .t = INFINITY,
                                 .t_max = INFINITY,
                                 .instance = REFERENCE_NONE,
                                 .primitive = REFERENCE_NONE,
                                 .material = REFERENCE_NONE,
                                 .medium = media_top(&ray->media),
                                 .light = REFERENCE_NONE};
    store(ray->origin, node.origin);
    store(ray->dir, node.dir);
    store(ray->weight, node.weight);
    return tree_record(tracer, &node);
}

static void record_candidate(struct tracer *tracer, const struct ray *ray, const struct hit *hit,
                             const struct surface *s)
{
    if (ray->node == REFERENCE_NONE)
        return;
    struct reference_ray *node = &tracer->nodes[ray->node];
    node->t = hit->t;
    node->instance = hit->instance;
    node->primitive = hit->primitive;
    node->material = s->material_index;
    store(s->ns, node->normal);
}

static void record_end(struct tracer *tracer, const struct ray *ray, whit_probe_end end,
                       struct dvec3 radiance)
{
    if (ray->node == REFERENCE_NONE)
        return;
    tracer->nodes[ray->node].end = end;
    store(radiance, tracer->nodes[ray->node].radiance);
}

/* ---- Rays that a surface calls for ---- */

/* Puts a ray on the stack, or records that it is cut by depth or bail-out. False: its weight is
   0. */
static bool push_ray(struct tracer *tracer, const struct ray *ray, bool deep)
{
    double largest = d3_largest(ray->weight);
    if (!(largest > 0.0))
        return false;
    bool small = largest < tracer->reference->bailout;
    if (deep || small) {
        tracer->cut_depth += deep;
        tracer->cut_bailout += !deep;
        record_ray(tracer, ray, deep ? WHIT_PROBE_DEPTH : WHIT_PROBE_BAILOUT);
        return true;
    }
    ++tracer->rays[ray->kind];
    if (!ARRAY_PUSH(tracer->stack, tracer->stack_count, tracer->stack_capacity, *ray))
        tracer->lacks_memory = true;
    return true;
}

/* A ray that starts behind the surface. */
static struct ray beyond(const struct ray *ray, const struct crossing *c, struct dvec3 dir,
                         struct dvec3 weight, uint32_t kind)
{
    return (struct ray){.origin = dvec3_along(c->p, c->ng, -c->room),
                        .dir = dir,
                        .weight = weight,
                        .media = ray->media,
                        .steps = ray->steps + STEPS_OF_BOUNCE,
                        .kind = kind,
                        .skip_instance = c->instance,
                        .skip_primitive = c->primitive,
                        .node = ray->node,
                        .way = ray->way};
}

static bool push_refracted(struct tracer *tracer, const struct ray *ray, const struct surface *s,
                           const struct optics *o, const struct crossing *c, bool deep)
{
    struct dvec3 weight = d3_scale(d3_times(ray->weight, o->refracted), 1.0 - o->straight);
    struct dvec3 dir = ray->dir;
    if (!o->thin && !optics_refract(ray->dir, s->ns, o->eta, &dir))
        return false;
    /* By the shading normal the refracted ray may stay on its side of the surface; then it goes
       straight on. */
    if (dvec3_dot(dir, s->ng) >= 0.0 || dvec3_dot(dir, c->ng) >= 0.0)
        dir = ray->dir;
    struct ray child = beyond(ray, c, dir, weight, REFERENCE_REFRACTED);
    if (!o->thin)
        child.media = c->after;
    return push_ray(tracer, &child, deep);
}

static bool push_reflected(struct tracer *tracer, const struct ray *ray, const struct surface *s,
                           const struct optics *o, const struct crossing *c, const struct hit *hit,
                           bool deep)
{
    struct dvec3 dir = optics_reflect(ray->dir, s->ns);
    if (dvec3_dot(dir, s->ng) <= 0.0)
        dir = optics_reflect(ray->dir, s->ng);
    const struct ray child = {.origin = dvec3_along(s->p, s->ng, s->room),
                              .dir = d3_unit_or(dir, s->ng),
                              .weight =
                                  d3_scale(d3_times(ray->weight, o->reflected), 1.0 - o->straight),
                              .media = c->before,
                              .steps = ray->steps + STEPS_OF_BOUNCE,
                              .kind = REFERENCE_REFLECTED,
                              .skip_instance = hit->instance,
                              .skip_primitive = hit->primitive,
                              .node = ray->node,
                              .way = ray->way};
    return push_ray(tracer, &child, deep);
}

/* Pushes refracted, straight and reflected rays; false: the surface calls for none. */
static bool push_children(struct tracer *tracer, const struct ray *ray, const struct surface *s,
                          const struct optics *o, const struct crossing *c, const struct hit *hit)
{
    bool deep = ray_bounces(ray->steps) >= tracer->reference->params.picture.depth;
    struct ray straight =
        beyond(ray, c, ray->dir, d3_scale(ray->weight, o->straight), REFERENCE_STRAIGHT);
    bool any = push_refracted(tracer, ray, s, o, c, deep);
    any |= push_ray(tracer, &straight, deep);
    any |= push_reflected(tracer, ray, s, o, c, hit, deep);
    return any;
}

/* Sends the ray straight on, where both sides of a surface are the same medium. */
static void push_through(struct tracer *tracer, const struct ray *ray, const struct crossing *c)
{
    uint32_t depth = tracer->reference->params.picture.depth;
    struct ray child = beyond(ray, c, ray->dir, ray->weight, REFERENCE_REFRACTED);
    child.steps = ray->steps + 1;
    child.media = c->after;
    push_ray(tracer, &child, depth == 0 || ray_bounces(child.steps) > depth);
}

/* ---- A ray's own light ---- */

/* Sets s->footprint: projects the two sides of the ray's footprint along the ray onto the
   surface. */
static void take_footprint(const struct tracer *tracer, const struct ray *ray, struct surface *s)
{
    double side =
        sqrt(camera_texel_area(tracer->reference, tracer->x, tracer->y, tracer->sample, ray->way));
    struct dvec3 other = fabs(ray->dir.x) < 0.5 ? d3(1, 0, 0) : d3(0, 1, 0);
    struct dvec3 asides[2];
    asides[0] = d3_unit_or(dvec3_cross(ray->dir, other), other);
    asides[1] = dvec3_cross(ray->dir, asides[0]);
    double volume = dvec3_dot(dvec3_cross(s->e1, s->e2), ray->dir);
    for (int i = 0; i < 2; ++i) { /* side * aside = u e1 + v e2 + w dir, by Cramer's rule */
        struct dvec3 moved = d3_scale(asides[i], side);
        s->footprint[i][0] = dvec3_dot(dvec3_cross(moved, s->e2), ray->dir) / volume;
        s->footprint[i][1] = dvec3_dot(dvec3_cross(s->e1, moved), ray->dir) / volume;
    }
}

static struct dvec3 shade_hit(struct tracer *tracer, struct ray *ray, const struct hit *hit)
{
    const struct reference *reference = tracer->reference;
    struct surface s = surface_at(reference, hit);
    bool inside = surface_face(&s, ray->dir);
    struct crossing c = media_cross(tracer, ray, hit, &s, inside);
    ray->way += hit->t;
    take_footprint(tracer, ray, &s);
    if (!c.seen) {
        record_candidate(tracer, ray, hit, &s);
        record_end(tracer, ray, WHIT_PROBE_DIVIDED, d3_all(0.0));
        push_through(tracer, ray, &c);
        return d3_all(0.0);
    }
    struct optics o = optics_at(reference, &s, ray->dir, c.eta);
    if (dvec3_dot(s.ns, ray->dir) > 0.0)
        s.ns = s.ng;
    record_candidate(tracer, ray, hit, &s);
    if (s.material->shadow_catcher)
        optics_make_catcher(&o);
    struct dvec3 open = d3_all(0.0), light = d3_add(o.diffuse, o.emission);
    if (!o.unlit)
        light = lighting_local(tracer, &s, &o, ray, hit, &c.before, &open);
    struct dvec3 radiance = d3_scale(d3_times(light, ray->weight), 1.0 - o.straight);
    if (s.material->shadow_catcher)
        ray->weight = d3_times(ray->weight, lighting_caught(light, open));
    bool goes_on = push_children(tracer, ray, &s, &o, &c, hit);
    record_end(tracer, ray, goes_on ? WHIT_PROBE_DIVIDED : WHIT_PROBE_OPAQUE, radiance);
    return radiance;
}

static struct dvec3 follow(struct tracer *tracer, struct ray *ray, const struct hit *hit)
{
    const struct reference *reference = tracer->reference;
    ray->node = record_ray(tracer, ray, WHIT_PROBE_MISSED);
    ray->weight = d3_times(ray->weight, media_transmittance(reference, &ray->media, hit->t));
    bool absorbed = d3_largest(ray->weight) < DBL_MIN;
    if (!absorbed && hit->primitive != HIT_NONE)
        return shade_hit(tracer, ray, hit);
    struct dvec3 radiance = d3_all(0.0);
    if (!absorbed)
        radiance = d3_times(light_sky(reference, ray->dir), ray->weight);
    record_end(tracer, ray, absorbed ? WHIT_PROBE_ABSORBED : WHIT_PROBE_MISSED, radiance);
    return radiance;
}

struct dvec3 tree_trace(struct tracer *tracer, uint32_t x, uint32_t y, struct hit *first)
{
    struct ray ray = camera_first_ray(tracer->reference, x, y, tracer->sample);
    struct dvec3 sum;
    tracer->x = x;
    tracer->y = y;
    tracer->stack_count = 0;
    ++tracer->rays[RAY_PRIMARY];
    *first = hit_closest(tracer->reference, &ray);
    sum = follow(tracer, &ray, first);
    while (tracer->stack_count > 0 && !tracer->lacks_memory) {
        ray = tracer->stack[--tracer->stack_count];
        struct hit hit = hit_closest(tracer->reference, &ray);
        sum = d3_add(sum, follow(tracer, &ray, &hit));
    }
    return sum;
}

void tree_finish(struct tracer *tracer)
{
    free(tracer->stack);
    free(tracer->nodes);
    tracer->stack = NULL;
    tracer->nodes = NULL;
}

/* Direct light on a surface, with shadows. */
#include <string.h>

#include "base/same.h"
#include "picture/params.h"
#include "reference/hits.h"
#include "reference/inside.h"
#include "reference/light.h"
#include "reference/lighting.h"
#include "reference/media.h"
#include "reference/tree.h"

#define SMOOTH_COSINE 0.7071067811865476 /* 45 degrees: above it a mesh is not smooth */

/* The hit point that shadow rays start from: data that all shadow rays of the hit share. */
struct receiver {
    const struct surface *s;
    const struct ray *ray; /* the ray that hit the surface */
    struct dvec3 lift;     /* from the hit point to the start of shadow rays */
    struct dvec3 absorption;
    uint32_t instance, primitive; /* of the hit */
    bool lifted;                  /* `lift` is not 0 */
};

/* The offset of a point to its projection on the tangent plane at a vertex; 0 where that would be
   inwards. `from`: the point relative to the vertex. */
static struct dvec3 lift_to_plane(struct dvec3 from, struct dvec3 n, struct dvec3 ng, double slack,
                                  bool *smooth)
{
    double cosine = dvec3_dot(n, ng);
    if (cosine < 0.0)
        n = d3_scale(n, -1.0);
    *smooth = *smooth && fabs(cosine) >= SMOOTH_COSINE;
    return d3_scale(n, fmax(-dvec3_dot(from, n) - slack, 0.0));
}

/* The offset of the hit point to the mean of its projections on the vertices' tangent planes
   (Hanika 2021, "Hacking the Shadow Terminator"). As in the kernels, surfaces flatter than `slack`
   count as flat. */
static struct dvec3 smooth_lift(const struct reference *reference, const struct surface *s)
{
    struct dvec3 from = dvec3_along(d3_scale(s->e1, s->u), s->e2, s->v);
    const struct dvec3 away[3] = {from, dvec3_sub(from, s->e1), dvec3_sub(from, s->e2)};
    const double weights[3] = {1.0 - s->u - s->v, s->u, s->v};
    double slack = fmax(d3_size(s->e1), d3_size(s->e2)) / 65536.0;
    struct dvec3 lift = d3_all(0.0);
    bool smooth = !s->sphere;
    for (uint32_t i = 0; i < 3; ++i) {
        struct dvec3 n = surface_vertex_normal(reference, s, i);
        lift = dvec3_along(lift, lift_to_plane(away[i], n, s->ng, slack, &smooth), weights[i]);
    }
    return smooth ? lift : d3_all(0.0);
}

/* The share of light that filters on the way and the media around the receiver transmit. */
static struct dvec3 share_of(const struct reference *reference, const struct receiver *at,
                             const struct shadow *shadow)
{
    double share[3];
    double around[3] = {at->absorption.x, at->absorption.y, at->absorption.z};
    for (int c = 0; c < 3; ++c) {
        double stops = around[c] * shadow->filter_end * FILTER_DEPTH_OF_ABSORPTION;
        if (reference->params.whole_stops)
            stops = floor(stops + 0.5);
        stops = fmax(shadow->stops[c] + stops, 0.0);
        share[c] = same_pow(2.0, -stops / FILTER_DEPTH_SCALE);
    }
    return d3(share[0], share[1], share[2]);
}

static whit_probe_end end_of_share(struct dvec3 share)
{
    bool all = share.x >= 1.0 && share.y >= 1.0 && share.z >= 1.0;
    return all                       ? WHIT_PROBE_REACHED
           : d3_largest(share) > 0.0 ? WHIT_PROBE_FILTERED
                                     : WHIT_PROBE_ABSORBED;
}

static void record_shadow(struct tracer *tracer, const struct receiver *at,
                          const struct shadow_ray *ray, const struct shadow *shadow,
                          struct dvec3 share, uint32_t light, uint32_t point)
{
    const struct hit *blocker = &shadow->blocker;
    struct reference_ray node = {
        .kind = REFERENCE_SHADOW,
        .end = shadow->blocked ? WHIT_PROBE_BLOCKED : end_of_share(share),
        .parent = at->ray->node,
        .bounces = ray_bounces(at->ray->steps),
        .origin = {ray->origin.x, ray->origin.y, ray->origin.z},
        .dir = {ray->dir.x, ray->dir.y, ray->dir.z},
        .t = shadow->blocked ? blocker->t : ray->distance,
        .t_max = ray->distance,
        .instance = blocker->instance,
        .primitive = blocker->primitive,
        .material = REFERENCE_NONE,
        .medium = REFERENCE_NONE,
        .light = light,
        .point = point,
        .weight = {share.x, share.y, share.z},
    };
    if (shadow->blocked)
        node.material = surface_at(tracer->reference, blocker).material_index;
    tree_record(tracer, &node);
}

/* The share of a light point's light that reaches the hit, by a shadow ray. A lifted start may be
   lit from below the plane of its triangle; then the triangle itself can block the ray. */
static struct dvec3 light_share(struct tracer *tracer, const struct receiver *at,
                                const struct light_sample_info *from, uint32_t light,
                                uint32_t point)
{
    const struct reference *reference = tracer->reference;
    if (reference->params.picture.shadows == WHIT_SHADOWS_NONE)
        return d3_all(1.0);
    const struct surface *s = at->s;
    bool above = dvec3_dot(from->to_light, s->ng) > 0.0;
    struct shadow_ray ray = {.origin = dvec3_along(d3_add(s->p, at->lift), s->ng, s->room),
                             .dir = from->to_light,
                             .distance = from->distance,
                             .skip_instance = at->instance,
                             .skip_primitive = above ? at->primitive : HIT_NONE};
    if (at->lifted && isfinite(ray.distance)) {
        struct dvec3 way = dvec3_sub(dvec3_along(s->p, from->to_light, from->distance), ray.origin);
        ray.distance = d3_length(way);
        ray.dir = d3_unit_or(way, ray.dir);
    }
    struct shadow shadow = hit_shadow(reference, &ray);
    struct dvec3 share = shadow.blocked ? d3_all(0.0) : share_of(reference, at, &shadow);
    ++tracer->rays[RAY_SHADOW];
    if (tracer->records)
        record_shadow(tracer, at, &ray, &shadow, share, light, point);
    return share;
}

/* Sums over the points of one light. For flat emitters the points give only the visible share, each
   point weighted by its light; the light itself is the exact integral over the emitter. Highlights
   are not scaled up where points miss most of what is above the horizon. */
struct lit {
    struct dvec3 sum, open; /* open: without shadows */
    double weight;          /* flat emitters: sum of cos cos / distance^2 */
    struct dvec3 visible, highlight;
};

static void add_point(struct tracer *tracer, const struct receiver *at, const struct optics *o,
                      uint32_t index, uint32_t point, struct lit *lit)
{
    const struct scene_light *light = &tracer->reference->pose.lights[index];
    const struct surface *s = at->s;
    struct light_sample_info from;
    if (!light_at(tracer, light, point, s->p, &from))
        return;
    double cos_light = dvec3_dot(from.to_light, s->ns);
    if (!(cos_light > 0.0))
        return;
    bool wanted = at->lifted || dvec3_dot(from.to_light, s->ng) > 0.0;
    struct dvec3 highlight =
        optics_highlight(o, s->ns, from.to_light, d3_scale(at->ray->dir, -1.0));
    struct dvec3 reflected = dvec3_along(highlight, o->diffuse, cos_light);
    wanted = wanted && !(reflected.x + reflected.y + reflected.z <=
                         tracer->reference->bailout * BAILOUT_SHADOW_SHARE);
    struct dvec3 share = d3_all(0.0);
    if (wanted)
        share = light_share(tracer, at, &from, index, point);
    if (scene_light_is_flat(light)) {
        double weight = cos_light * from.strength;
        lit->weight += weight;
        lit->visible = dvec3_along(lit->visible, share, weight);
        lit->highlight = dvec3_along(lit->highlight, d3_times(highlight, share), from.strength);
    } else if (wanted) {
        struct dvec3 arriving = d3_times(reflected, from.arriving);
        lit->open = d3_add(lit->open, arriving);
        lit->sum = d3_add(lit->sum, d3_times(arriving, share));
    }
}

static void add_emitter(const struct reference *reference, const struct scene_light *light,
                        const struct surface *s, const struct optics *o, struct lit *lit)
{
    if (!(lit->weight > 0.0))
        return;
    double factor = light_form_factor(light, s->p, s->ns);
    double share = light_area_share(reference, light);
    struct dvec3 radiance = d3_load(light->color);
    struct dvec3 seen = d3_scale(lit->visible, factor / lit->weight);
    struct dvec3 highlight =
        d3_scale(lit->highlight, share * fmin(factor / (share * lit->weight), 1.0));
    struct dvec3 light_seen = d3_add(d3_times(o->diffuse, seen), highlight);
    lit->sum = d3_add(lit->sum, d3_times(radiance, light_seen));
    lit->open = d3_add(lit->open, d3_times(radiance, d3_scale(o->diffuse, factor)));
}

struct dvec3 lighting_local(struct tracer *tracer, const struct surface *s, const struct optics *o,
                            const struct ray *ray, const struct hit *hit, const struct media *media,
                            struct dvec3 *open)
{
    const struct reference *reference = tracer->reference;
    const struct scene_pose *pose = &reference->pose;
    struct dvec3 sum =
        d3_add(o->emission, d3_times(o->ambient, d3_load(reference->scene->ambient)));
    struct receiver at = {.s = s,
                          .ray = ray,
                          .lift = smooth_lift(reference, s),
                          .absorption = media_absorption(reference, media),
                          .instance = hit->instance,
                          .primitive = hit->primitive};
    if (reference->params.picture.shadows == WHIT_SHADOWS_NONE)
        at.lift = d3_all(0.0);
    if (reference->params.picture.shadows == WHIT_SHADOWS_OPAQUE)
        at.absorption = d3_all(0.0);
    at.lifted = !d3_is_zero(at.lift);
    *open = d3_all(0.0);
    for (uint32_t i = 0; i < pose->light_count; ++i) {
        const struct scene_light *light = &pose->lights[i];
        bool flat = scene_light_is_flat(light);
        struct lit lit = {.weight = 0.0};
        for (uint32_t k = 0; k < (flat ? reference->light_samples : 1); ++k)
            add_point(tracer, &at, o, i, k, &lit);
        if (flat)
            add_emitter(reference, light, s, o, &lit);
        sum = d3_add(sum, lit.sum);
        *open = d3_add(*open, lit.open);
    }
    return sum;
}

static double caught(double light, double open)
{
    return open > 1e-30 ? clamp_unit(light / open) : 1.0;
}

struct dvec3 lighting_caught(struct dvec3 light, struct dvec3 open)
{
    return d3(caught(light.x, open.x), caught(light.y, open.y), caught(light.z, open.z));
}

/* Finds hits by the conservative traversal in double, with the rules of surfaces for each kind of
   ray: cut-outs, one-sided surfaces, filters of shadow rays. Among hits with equal t the one with
   the smaller instance, then the smaller primitive, comes first. */
#include <string.h>

#include "accel/hit_order.h"
#include "base/same.h"
#include "oracle/conservative.h"
#include "picture/media.h"
#include "reference/hits.h"
#include "reference/meet.h"
#include "reference/surface.h"
#include "reference/texture.h"

/* Relative growth of the boxes, whose bounds are floats: more than their rounding errors and those
   of the traversal. */
#define BOX_GROWTH          0x1p-40
#define BOX_GROWTH_INSTANCE 0x1p-20

enum mode { MODE_CLOSEST, MODE_NEXT, MODE_SHADOW };

struct search {
    struct conservative_walk walk;
    const struct reference *reference;
    enum mode mode;
    double world_origin[3], world_dir[3];
    struct line line; /* the ray in the space of the tree that is being traversed */
    uint32_t skip_instance, skip_primitive;
    const struct hit *known; /* MODE_NEXT */
    double filter_end;       /* MODE_SHADOW: the t from which absorption is measured */
    double stops[3];
    struct hit best;
};

static void take_line(struct search *s, const double origin[3], const double dir[3], double growth)
{
    s->line = line_make(origin, dir);
    memcpy(s->walk.ray.origin, origin, sizeof s->walk.ray.origin);
    memcpy(s->walk.ray.dir, dir, sizeof s->walk.ray.dir);
    s->walk.ray.growth = growth;
}

static bool enter_instance(struct conservative_walk *walk, uint32_t instance)
{
    struct search *s = (struct search *)walk;
    const struct affine *inverse = &s->reference->placings[instance].inverse;
    double origin[3], dir[3];
    affine_point(inverse, s->world_origin, origin);
    affine_vector(inverse, s->world_dir, dir);
    take_line(s, origin, dir, BOX_GROWTH);
    return true;
}

static struct hit_place place_of(const struct hit *hit)
{
    return (struct hit_place){hit->t, hit->instance, hit->primitive};
}

/* Whether a candidate is within the ray's reach, comes before the best hit so far, and is on a
   surface that rays of this kind can hit. */
static bool is_reached(const struct search *s, const struct candidate *m,
                       const struct gpu_triangle *record, uint32_t instance)
{
    if (!m->met || !(m->t >= 0.0) || !(m->t <= s->walk.ray.t_max))
        return false;
    if (s->mode == MODE_SHADOW)
        return !(record->flags & TRIANGLE_NO_SHADOW);
    if (!m->front && (record->flags & TRIANGLE_ONE_SIDED))
        return false;
    struct hit_place place = {m->t, instance, record->primitive};
    return (s->mode != MODE_NEXT || hit_comes_before(place_of(s->known), place)) &&
           hit_comes_before(place, place_of(&s->best));
}

/* Compares as floats, since the cutoff is one, and an opacity may be meant to equal it. */
static bool is_solid(const struct search *s, const struct candidate *m,
                     const struct gpu_triangle *record, uint32_t instance)
{
    if (!(record->flags & TRIANGLE_CUTOUT))
        return true;
    struct surface place = surface_texture_place(s->reference, instance, m, record);
    return place.material->alpha != SCENE_ALPHA_MASK ||
           (float)(texture_opacity(s->reference, &place) * place.alpha) >=
               place.material->alpha_cutoff;
}

static double stops_of(const struct reference *reference, double kept)
{
    if (!(kept > 0.0))
        return reference->params.whole_stops ? FILTER_DEPTH_OPAQUE : INFINITY;
    double stops = fmax(-SHADOW_DEPTH_SCALE * same_log2(kept), 0.0);
    return FILTER_DEPTH_OF_RECORD * (reference->params.whole_stops ? floor(stops + 0.5) : stops);
}

/* The share of light that a filter transmits: 1 - cover passes beside the surface, the rest through
   it. */
static struct dvec3 kept_by(const struct reference *reference, const struct surface *place)
{
    const struct scene_material *m = place->material;
    struct dvec3 passes = d3_scale(d3_load(m->transmission),
                                   texture_sample(reference, place, SCENE_SLOT_TRANSMISSION).rgb.x);
    if (m->model == WHIT_MODEL_METAL_ROUGH) {
        double metallic =
            (double)m->metallic * texture_sample(reference, place, SCENE_SLOT_METAL_ROUGH).rgb.z;
        struct dvec3 base = d3_times(d3_load(m->diffuse), place->color);
        base = d3_times(base, texture_sample(reference, place, SCENE_SLOT_DIFFUSE).rgb);
        passes = d3_scale(d3_times(passes, base), 1.0 - metallic);
    }
    double cover = 1.0;
    if (m->alpha == SCENE_ALPHA_BLEND)
        cover = clamp_unit(texture_opacity(reference, place) * place->alpha);
    return dvec3_along(d3_all(1.0 - cover), passes, cover);
}

/* Adds the stops of a filter. For filters without textures and absorption, kernels read whole stops
   from the record, ten bits per channel. */
static void add_filter(struct search *s, const struct candidate *m,
                       const struct gpu_triangle *record, uint32_t instance)
{
    const struct reference *reference = s->reference;
    bool detail = (record->flags & TRIANGLE_FILTER_DETAIL) != 0;
    if (!m->owned) /* at an edge that two triangles share only one of them counts */
        return;
    if (!detail && reference->params.whole_stops) {
        for (int c = 0; c < 3; ++c)
            s->stops[c] += (record->shadow >> (10 * c) & 1023u) * FILTER_DEPTH_OF_RECORD;
        return;
    }
    struct surface place = surface_texture_place(reference, instance, m, record);
    struct dvec3 kept = kept_by(reference, &place);
    s->stops[0] += stops_of(reference, kept.x);
    s->stops[1] += stops_of(reference, kept.y);
    s->stops[2] += stops_of(reference, kept.z);
    for (int c = 0; detail && !place.material->thin_walled && c < 3; ++c) {
        double absorbed = (double)place.material->absorption[c] * (s->filter_end - m->t) *
                          FILTER_DEPTH_OF_ABSORPTION;
        if (reference->params.whole_stops)
            absorbed = floor(absorbed + 0.5);
        s->stops[c] += m->front ? absorbed : -absorbed;
    }
}

/* Accepts a candidate as the best hit, or adds its filter. True: it is the best hit now. */
static bool take_candidate(struct search *s, const struct candidate *m, uint32_t record_index,
                           uint32_t instance)
{
    const struct gpu_triangle *record = &s->reference->accel->triangles[record_index];
    if (!is_reached(s, m, record, instance) || !is_solid(s, m, record, instance))
        return false;
    if (s->mode == MODE_SHADOW && (record->flags & TRIANGLE_FILTER) &&
        s->reference->params.picture.shadows != WHIT_SHADOWS_OPAQUE) {
        add_filter(s, m, record, instance);
        return false;
    }
    s->best = (struct hit){.t = m->t,
                           .u = m->u,
                           .v = m->v,
                           .normal = m->normal,
                           .record = record_index,
                           .primitive = record->primitive,
                           .instance = instance};
    s->walk.limit = m->t;
    s->walk.done = s->mode == MODE_SHADOW;
    return true;
}

static void visit_record(struct conservative_walk *walk, uint32_t index, uint32_t instance)
{
    struct search *s = (struct search *)walk;
    const struct gpu_triangle *record = &walk->accel->triangles[index];
    bool self = s->mode != MODE_NEXT && record->primitive == s->skip_primitive &&
                instance == s->skip_instance;
    struct candidate m;
    if (record->flags & TRIANGLE_SPHERE) {
        m = meet_sphere(&s->line, record, false, self);
        bool ended = take_candidate(s, &m, index, instance);
        m = meet_sphere(&s->line, record, true, self);
        if (!ended)
            take_candidate(s, &m, index, instance);
        return;
    }
    if (self)
        return;
    m = meet_triangle(&s->line, record);
    if (record->flags & TRIANGLE_MIRRORED && walk->accel->flat)
        m.front = !m.front;
    take_candidate(s, &m, index, instance);
}

static struct search search_begin(const struct reference *reference, enum mode mode,
                                  struct dvec3 origin, struct dvec3 dir, double t_max)
{
    struct search s = {.walk = {.accel = reference->accel,
                                .limit = INFINITY,
                                .ray = {.t_max = t_max},
                                .enter = enter_instance,
                                .visit = visit_record},
                       .reference = reference,
                       .mode = mode,
                       .world_origin = {origin.x, origin.y, origin.z},
                       .world_dir = {dir.x, dir.y, dir.z},
                       .best = {.t = INFINITY, .primitive = HIT_NONE, .instance = HIT_NONE}};
    bool one_space = reference->accel->single_identity || reference->accel->flat;
    take_line(&s, s.world_origin, s.world_dir, one_space ? BOX_GROWTH : BOX_GROWTH_INSTANCE);
    return s;
}

struct hit hit_closest(const struct reference *reference, const struct ray *ray)
{
    struct search s = search_begin(reference, MODE_CLOSEST, ray->origin, ray->dir, INFINITY);
    s.skip_instance = ray->skip_instance;
    s.skip_primitive = ray->skip_primitive;
    conservative_walk_run(&s.walk);
    return s.best;
}

struct hit hit_next(const struct reference *reference, const struct ray *ray,
                    const struct hit *known, double t_max)
{
    struct search s = search_begin(reference, MODE_NEXT, ray->origin, ray->dir, t_max);
    s.known = known;
    conservative_walk_run(&s.walk);
    return s.best;
}

struct shadow hit_shadow(const struct reference *reference, const struct shadow_ray *ray)
{
    struct search s = search_begin(reference, MODE_SHADOW, ray->origin, ray->dir, ray->distance);
    s.skip_instance = ray->skip_instance;
    s.skip_primitive = ray->skip_primitive;
    s.filter_end = media_shadow_end(&reference->frame, s.world_origin, ray->distance);
    conservative_walk_run(&s.walk);
    struct shadow out = {
        .blocked = s.best.primitive != HIT_NONE, .blocker = s.best, .filter_end = s.filter_end};
    memcpy(out.stops, s.stops, sizeof out.stops);
    return out;
}

/* Nested media (Schmidt and Budge 2002, "Simple Nested Dielectrics in Ray Traced Images"), and
   touching surfaces of several media, which a ray crosses at one place. */
#include "reference/media.h"
#include "base/same.h"
#include "reference/hits.h"

#include "picture/bodies.h"

/* Surfaces count as touching within a few rounding errors of floats, since vertices are floats. */
#define FLOAT_ROUNDINGS 8.0
#define ROUNDING        0x1p-24

enum { CROSSED_MAX = 4 };

static uint32_t priority_of(const struct reference *reference, uint32_t entry)
{
    return reference->scene->materials[entry - 1].priority;
}

static double index_of(const struct reference *reference, uint32_t material)
{
    return material == SCENE_NONE ? 1.0 : (double)reference->scene->materials[material].ior;
}

uint32_t media_top(const struct media *media)
{
    return media->count ? media->entries[media->count - 1] - 1 : SCENE_NONE;
}

static void put_in(struct tracer *tracer, struct media *media, uint32_t entry)
{
    uint32_t at = media->count;
    if (media->count == MEDIA_MAX) {
        tracer->too_many_media = true;
        return;
    }
    for (; at > 0 && priority_of(tracer->reference, media->entries[at - 1]) >
                         priority_of(tracer->reference, entry);
         --at)
        media->entries[at] = media->entries[at - 1];
    media->entries[at] = entry;
    ++media->count;
}

/* Takes the last occurrence of `entry` out; false: there is none. */
static bool take_out(struct media *media, uint32_t entry)
{
    uint32_t at = media->count;
    while (at > 0 && media->entries[at - 1] != entry)
        --at;
    if (at == 0)
        return false;
    for (; at < media->count; ++at)
        media->entries[at - 1] = media->entries[at];
    --media->count;
    return true;
}

static bool have(const struct media *media, uint32_t entry)
{
    struct media copy = *media;
    return take_out(&copy, entry);
}

static double transmitted(double absorption, double t)
{
    return absorption > 0.0 ? same_exp(-absorption * t) : 1.0;
}

struct dvec3 media_transmittance(const struct reference *reference, const struct media *media,
                                 double t)
{
    uint32_t material = media_top(media);
    if (material == SCENE_NONE)
        return d3_all(1.0);
    struct dvec3 a = d3_load(reference->scene->materials[material].absorption);
    return d3(transmitted(a.x, t), transmitted(a.y, t), transmitted(a.z, t));
}

struct dvec3 media_absorption(const struct reference *reference, const struct media *media)
{
    struct dvec3 sum = d3_all(0.0);
    for (uint32_t i = 0; i < media->count; ++i)
        sum = d3_add(sum, d3_load(reference->scene->materials[media->entries[i] - 1].absorption));
    return sum;
}

struct media media_around_eye(const struct reference *reference)
{
    const struct gpu_frame *frame = &reference->frame;
    const uint32_t words[] = {frame->eye_media0, frame->eye_media1, frame->eye_media2,
                              frame->eye_media3};
    struct media media = {.count = 0};
    for (uint32_t i = 0; i < MEDIA_MAX; ++i) {
        uint32_t entry = words[i / 2] >> (16 * (i % 2)) & 0xffffu;
        if (entry)
            media.entries[media.count++] = entry;
    }
    return media;
}

/* ---- Surfaces that are crossed at one place ---- */

struct crossed {
    uint32_t entries[CROSSED_MAX], instances[CROSSED_MAX];
    bool leaving[CROSSED_MAX];
    uint32_t count;
};

/* The index of the last crossed surface of the same body (material and instance); CROSSED_MAX:
   none. */
static uint32_t find_crossed(const struct crossed *crossed, uint32_t entry, uint32_t instance)
{
    for (uint32_t i = crossed->count; i > 0; --i) {
        if (crossed->entries[i - 1] == entry && crossed->instances[i - 1] == instance)
            return i - 1;
    }
    return CROSSED_MAX;
}

static void add_crossed(struct crossed *crossed, uint32_t entry, uint32_t instance, bool leaving)
{
    crossed->entries[crossed->count] = entry;
    crossed->instances[crossed->count] = instance;
    crossed->leaving[crossed->count++] = leaving;
}

/* The distance along the ray within which two hits count as one place, since rounding errors may
   have put them that far apart. */
static double slack(const struct surface *s, const struct ray *ray, double t)
{
    double size = d3_size(ray->origin) + d3_size(s->p) + d3_size(s->e1) + d3_size(s->e2) + t;
    return FLOAT_ROUNDINGS * ROUNDING * size / fmax(fabs(dvec3_dot(ray->dir, s->ng)), 1.0 / 1024.0);
}

static double contact(const struct reference *reference, const struct surface *s,
                      const struct ray *ray)
{
    return (double)reference->frame.contact / fmax(fabs(dvec3_dot(ray->dir, s->ng)), 1.0 / 16.0);
}

static uint32_t rank_of(const struct surface *s, bool inside)
{
    return 2 * s->material->priority + !inside;
}

/* Adds the surfaces that touch *s to `crossed`, and makes *s the visible one: that with the highest
   priority, among equal ones one that is entered. The point of *s stays that of the first surface,
   from which reflected rays start. */
static void gather_touching(const struct reference *reference, const struct ray *ray,
                            struct hit hit, struct crossed *crossed, struct crossing *c,
                            struct surface *s, bool inside)
{
    double near = hit.t + slack(s, ray, hit.t), reach = near + contact(reference, s, ray);
    uint32_t rank = rank_of(s, inside);
    while (crossed->count < CROSSED_MAX) {
        hit = hit_next(reference, ray, &hit, reach);
        if (hit.primitive == HIT_NONE)
            return;
        struct surface other = surface_at(reference, &hit);
        bool leaves = surface_face(&other, ray->dir);
        if (!bodies_bounded_by(other.material))
            return;
        uint32_t entry = other.material_index + 1;
        uint32_t same = find_crossed(crossed, entry, hit.instance);
        if (same != CROSSED_MAX && crossed->leaving[same] == leaves)
            continue; /* the neighbour triangle at a shared edge */
        if (same != CROSSED_MAX && hit.t > near)
            return; /* the far side of a body thinner than `contact`, which is not a contact */
        add_crossed(crossed, entry, hit.instance, leaves);
        c->p = other.p;
        c->ng = other.ng;
        c->room = other.room;
        c->instance = hit.instance;
        c->primitive = hit.primitive;
        if (rank_of(&other, leaves) > rank) {
            rank = rank_of(&other, leaves);
            other.p = s->p;
            other.room = s->room;
            *s = other;
        }
    }
}

/* Enters all media that are entered, then leaves others. A medium that is left without having been
   entered, as with open meshes, is added to `before`: the ray was in it. */
static void cross_all(struct tracer *tracer, const struct crossed *crossed, struct crossing *c)
{
    for (uint32_t i = 0; i < crossed->count; ++i) {
        if (!crossed->leaving[i])
            put_in(tracer, &c->after, crossed->entries[i]);
    }
    for (uint32_t i = 0; i < crossed->count; ++i) {
        if (crossed->leaving[i] && !take_out(&c->after, crossed->entries[i]))
            put_in(tracer, &c->before, crossed->entries[i]);
    }
}

/* Whether the hit is on the neighbour of the primitive on which the ray starts, at their shared
   edge: the ray has then crossed this surface already. */
static bool is_crossed_already(const struct ray *ray, const struct hit *hit,
                               const struct surface *s, bool inside)
{
    return hit->instance == ray->skip_instance && hit->t <= slack(s, ray, hit->t) &&
           have(&ray->media, s->material_index + 1) != inside;
}

struct crossing media_cross(struct tracer *tracer, const struct ray *ray, const struct hit *hit,
                            struct surface *s, bool inside)
{
    const struct reference *reference = tracer->reference;
    double ior = (double)s->material->ior;
    struct crossing c = {.before = ray->media,
                         .after = ray->media,
                         .eta = inside ? ior : 1.0 / ior,
                         .seen = true,
                         .p = s->p,
                         .ng = s->ng,
                         .room = s->room,
                         .instance = hit->instance,
                         .primitive = hit->primitive};
    if (!bodies_bounded_by(s->material))
        return c;
    if (is_crossed_already(ray, hit, s, inside)) {
        c.seen = false;
        return c;
    }
    struct crossed crossed = {.count = 0};
    add_crossed(&crossed, s->material_index + 1, hit->instance, inside);
    if (reference->frame.nested)
        gather_touching(reference, ray, *hit, &crossed, &c, s, inside);
    cross_all(tracer, &crossed, &c);
    uint32_t from = media_top(&c.before), to = media_top(&c.after);
    c.eta = index_of(reference, from) / index_of(reference, to);
    c.seen = from != to;
    return c;
}

/* Light from lights, from flat emitters by exact integrals, and from the sky. */
#include <float.h>

#include "base/same.h"
#include "base/vec.h"
#include "reference/light.h"

#define LIGHT_MAX 1e24

static struct dvec3 emitter_point(const struct tracer *tracer, const struct scene_light *light,
                                  uint32_t index)
{
    uint32_t before = sequence_light(tracer->sample) * tracer->reference->light_samples, at[2];
    sequence_point(before + index, at);
    double u = (at[0] >> 8) * 0x1p-24, v = (at[1] >> 8) * 0x1p-24;
    if (light->kind == WHIT_LIGHT_TRIANGLE) { /* area-preserving map of the square (Turk 1990) */
        double root = sqrt(u);
        u = root * (1.0 - v);
        v = root * v;
    }
    return dvec3_along(dvec3_along(dvec3_load(light->position), dvec3_load(light->edge_u), u),
                       dvec3_load(light->edge_v), v);
}

double light_area_share(const struct reference *reference, const struct scene_light *light)
{
    double area = d3_length(dvec3_cross(dvec3_load(light->edge_u), dvec3_load(light->edge_v)));
    if (light->kind == WHIT_LIGHT_TRIANGLE)
        area *= 0.5;
    return area / (PI * reference->light_samples);
}

/* `to_light`, `direction`: unit. */
static double spot_share(const struct scene_light *light, struct dvec3 to_light,
                         struct dvec3 direction)
{
    struct dvec3 off = d3_add(to_light, direction);
    double versine = 0.5 * dvec3_dot(off, off);
    double soft =
        clamp_unit(((double)light->versine_outer - versine) / scene_light_cone_width(light));
    return soft * soft;
}

static struct dvec3 at_most(struct dvec3 light)
{
    return d3(fmin(light.x, LIGHT_MAX), fmin(light.y, LIGHT_MAX), fmin(light.z, LIGHT_MAX));
}

/* How far before the light a shadow ray ends, so that a surface in which the light lies casts no
   shadow: where an emitter's plane and a surface's differ by roundings of their coordinates, this
   is what such a surface is off along the ray. */
static double end_before(const struct reference *reference, const struct scene_light *light,
                         struct dvec3 p, struct dvec3 way, double cos_away)
{
    double distance = d3_length(way);
    double end = (double)reference->light_ends[light - reference->pose.lights];
    if (!scene_light_is_flat(light) && light->kind != WHIT_LIGHT_AREA_SAMPLE)
        return distance * end;
    double off = fmax(end, (d3_size(p) + d3_size(way)) * LIGHT_END_ROUNDING);
    return fmin(distance * LIGHT_END_SHARE_MAX, off / fabs(cos_away));
}

bool light_at(const struct tracer *tracer, const struct scene_light *light, uint32_t index,
              struct dvec3 p, struct light_sample_info *sample)
{
    bool flat = scene_light_is_flat(light);
    *sample = (struct light_sample_info){.arriving = d3_load(light->color)};
    struct dvec3 direction = d3_unit_or(dvec3_load(light->direction), d3_all(0.0));
    if (light->kind == WHIT_LIGHT_DIRECTIONAL) {
        sample->to_light = d3_scale(direction, -1.0);
        sample->distance = INFINITY;
        return true;
    }
    struct dvec3 from = flat ? emitter_point(tracer, light, index) : dvec3_load(light->position);
    struct dvec3 way = dvec3_sub(from, p);
    sample->distance = d3_length(way);
    if (!(sample->distance > 0.0))
        return false;
    sample->to_light = d3_scale(way, 1.0 / sample->distance);
    double square = fmax(sample->distance * sample->distance, (double)FLT_MIN);
    double cos_away = -dvec3_dot(sample->to_light, direction), share = 1.0;
    double cos_emitter = light->two_sided ? fabs(cos_away) : fmax(cos_away, 0.0);
    if (light->falloff || flat || light->kind == WHIT_LIGHT_AREA_SAMPLE)
        share /= square;
    if (light->kind == WHIT_LIGHT_SPOT)
        share *= spot_share(light, sample->to_light, direction);
    if (light->kind == WHIT_LIGHT_AREA_SAMPLE)
        share *= cos_emitter;
    if (flat) {
        sample->strength = fmin(cos_emitter / square, LIGHT_MAX);
        share = light_area_share(tracer->reference, light) * sample->strength;
    }
    sample->arriving =
        at_most(d3_scale(sample->arriving, share * scene_light_fade(light, sample->distance)));
    sample->distance -= end_before(tracer->reference, light, p, way, cos_away);
    return d3_largest(sample->arriving) > 0.0;
}

/* ---- Form factors ---- */

/* An edge's term of the form factor (Lambert 1760): the angle that the edge a-b subtends, times the
   cosine between n and the normal of the plane through the point and the edge. */
static double edge_term(struct dvec3 n, struct dvec3 a, struct dvec3 b)
{
    /* a x b, by the difference and the shorter of the two: nothing cancels. */
    bool longer = dvec3_dot(a, a) > dvec3_dot(b, b);
    struct dvec3 normal =
        longer ? dvec3_cross(dvec3_sub(a, b), b) : dvec3_cross(a, dvec3_sub(b, a));
    double size = d3_length(normal);
    return size > 0.0 ? same_atan2(size, dvec3_dot(a, b)) * dvec3_dot(n, normal) / size : 0.0;
}

/* Clips a polygon to the half-space above the horizon of n (Sutherland and Hodgman); gives the
   number of corners in `out`. */
static int clip_to_horizon(struct dvec3 n, const struct dvec3 *corners, int count,
                           struct dvec3 *out)
{
    int kept = 0;
    for (int i = 0; i < count; ++i) {
        struct dvec3 a = corners[i], b = corners[(i + 1) % count];
        double up_a = dvec3_dot(n, a), up_b = dvec3_dot(n, b);
        if (up_a > 0.0)
            out[kept++] = a;
        if ((up_a > 0.0) == (up_b > 0.0))
            continue;
        out[kept++] = dvec3_dot(a, a) > dvec3_dot(b, b)
                          ? dvec3_along(b, dvec3_sub(a, b), up_b / (up_b - up_a))
                          : dvec3_along(a, dvec3_sub(b, a), up_a / (up_a - up_b));
    }
    return kept;
}

double light_form_factor(const struct scene_light *light, struct dvec3 p, struct dvec3 n)
{
    struct dvec3 u = dvec3_load(light->edge_u), v = dvec3_load(light->edge_v), clipped[8];
    struct dvec3 c0 = dvec3_sub(dvec3_load(light->position), p),
                 direction = dvec3_load(light->direction);
    bool triangle = light->kind == WHIT_LIGHT_TRIANGLE;
    const struct dvec3 corners[4] = {
        c0, d3_add(c0, u), triangle ? d3_add(c0, v) : d3_add(d3_add(c0, u), v), d3_add(c0, v)};
    double height = -dvec3_dot(c0, direction), sum = 0.0;
    /* The point is in the emitter's plane, within the rounding of corners to floats. */
    double rounded = fabs(direction.x) * (fabs(p.x) + fabs(light->position[0])) +
                     fabs(direction.y) * (fabs(p.y) + fabs(light->position[1])) +
                     fabs(direction.z) * (fabs(p.z) + fabs(light->position[2]));
    if (fabs(height) <= (double)FLT_EPSILON * rounded)
        return 0.0;
    int count = clip_to_horizon(n, corners, triangle ? 3 : 4, clipped);
    for (int i = 0; i < count; ++i)
        sum += edge_term(n, clipped[i], clipped[(i + 1) % count]);
    double factor = sum * (-0.5 / PI);
    return height > 0.0 ? fmax(factor, 0.0) : light->two_sided ? fmax(-factor, 0.0) : 0.0;
}

/* ---- The sky ---- */

static struct dvec3 sky_texel(const struct reference *reference, double x, double y)
{
    double last = (double)reference->sky_size - 1.0;
    size_t column = (size_t)fmin(fmax(x, 0.0), last), row = (size_t)fmin(fmax(y, 0.0), last);
    return d3_load(&reference->sky[4 * (row * reference->sky_size + column)]);
}

/* The sky in a unit direction, by an octahedral map with +y in its middle (Meyer et al. 2010). */
static struct dvec3 sky_map(const struct reference *reference, struct dvec3 dir)
{
    double size = fabs(dir.x) + fabs(dir.y) + fabs(dir.z), x = dir.x / size, z = dir.z / size;
    if (dir.y < 0.0) {
        double folded = copysign(1.0 - fabs(z), x >= 0.0 ? 1.0 : -1.0);
        z = copysign(1.0 - fabs(x), z >= 0.0 ? 1.0 : -1.0);
        x = folded;
    }
    x = (x * 0.5 + 0.5) * reference->sky_size - 0.5;
    z = (z * 0.5 + 0.5) * reference->sky_size - 0.5;
    double left = floor(x), top = floor(z);
    struct dvec3 above =
        d3_mix(sky_texel(reference, left, top), sky_texel(reference, left + 1.0, top), x - left);
    struct dvec3 below = d3_mix(sky_texel(reference, left, top + 1.0),
                                sky_texel(reference, left + 1.0, top + 1.0), x - left);
    return d3_mix(above, below, z - top);
}

struct dvec3 light_sky(const struct reference *reference, struct dvec3 dir)
{
    const struct scene_environment *sky = &reference->scene->environment;
    if (reference->sky)
        return sky_map(reference, dir);
    struct dvec3 end = d3_load(dir.y >= 0.0 ? sky->zenith : sky->ground);
    return d3_times(d3_mix(d3_load(sky->horizon), end, fmin(fabs(dir.y), 1.0)),
                    d3_load(sky->scale));
}

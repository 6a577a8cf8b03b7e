// The light that arrives at a lit hit from a light, and what the surface reflects of it.
#ifndef BIND_ARRIVAL_GLSL
#define BIND_ARRIVAL_GLSL

#include "../lib/optics.glsl"
#include "filter.glsl"
#include "lit.glsl"

// The light from one point of a light at one lit hit, and the shadow ray to that point.
struct Arrival {
    bool faces, wanted;
    bool above; // the light is also on the side of the triangle's own normal
    float cos_light, strength;
    vec3 highlight, reflected, arriving;
    vec3 dir; // of the shadow ray, unit
    float distance;
};

// Aims the shadow ray. A point that is lifted off its triangle may get light from below the
// triangle's plane; the shadow ray then must not skip the triangle.
void aim_at_light(Lit lit, LightSample light, inout Arrival a)
{
    a.dir = light.to_light;
    a.distance = light.distance;
    if (SPEC_TERMINATOR != 0u && (lit.flags & LIT_LIFTED) != 0u && a.distance < FLOAT_LARGEST) {
        vec3 way = lit.p + a.dir * a.distance - lit.origin;
        a.distance = length(way);
        a.dir = way / a.distance;
    }
}

// Aims the shadow ray to a point of the light, and sets what does not depend on the material. True: the
// light arrives on a side of the surface that receives it.
bool aim_from_surface(bool alive, Lit lit, gpu_light light, uint point, out LightSample at, out Arrival a)
{
    bool arrives = light_at(light, point, lit.p, at);
    a.cos_light = dot(at.to_light, lit.ns);
    a.faces = alive && arrives && a.cos_light > 0.0;
    a.strength = at.strength;
    a.arriving = at.arriving;
    a.above = dot(at.to_light, lit.ng) > 0.0;
    aim_at_light(lit, at, a);
    return a.faces && (a.above || (SPEC_TERMINATOR != 0u && (lit.flags & LIT_LIFTED) != 0u));
}

Arrival arrive(bool alive, Lit lit, gpu_light light, uint point)
{
    LightSample at;
    Arrival a;
    bool wanted = aim_from_surface(alive, lit, light, point, at, a);
    a.highlight = vec3(0.0);
    a.reflected = lit.diffuse * a.cos_light;
    if (SPEC_HIGHLIGHTS != 0u) {
        vec3 middle = normalize_or(at.to_light + lit.view, lit.ns);
        float cos_half = clamp(dot(middle, lit.ns), 0.0, 1.0);
        float cos_view = max(dot(lit.view, lit.ns), 0.0);
        bool metal_rough = SPEC_METAL_ROUGH != 0u && (lit.flags & LIT_METAL_ROUGH) != 0u;
        a.highlight = metal_rough ? lit.highlight * a.cos_light *
                                        ggx_highlight(cos_half, a.cos_light, cos_view, lit.gloss)
                                  : lit.highlight * blinn_highlight(cos_half, lit.gloss);
        a.reflected += a.highlight;
    }
    // NaN counts as wanted too, since it must show in the picture.
    a.wanted = wanted && !(a.reflected.r + a.reflected.g + a.reflected.b <= frame.bailout_shadow);
    return a;
}

// The share of light that passes along a shadow ray. `blocker`: its hit by TRAVERSE_SHADOW;
// `absorption`: of the media where the ray starts.
vec3 passing_share(Hit blocker, vec3 absorption)
{
    if (blocker.primitive != HIT_NONE)
        return vec3(0.0);
    if (SPEC_FILTERS == 0u)
        return vec3(1.0);
    ivec3 depth = blocker.filter_depth;
    if (SPEC_FILTER_DETAIL != FILTERS_PLAIN && SPEC_ABSORPTION != 0u)
        depth = max(depth + absorption_depth(absorption, blocker.filter_end), ivec3(0));
    return exp2(vec3(depth) * (-1.0 / FILTER_DEPTH_SCALE));
}

// Sums over the points of a flat emitter. Its diffuse light is computed for the whole polygon; the
// points only give the visible share, each weighted by the light that it would send.
struct EmitterSum {
    float weight;  // cos cos / distance^2
    vec3 visible;  // weight times the share that passes
    vec3 highlight;
};

// The light of a flat emitter, with shadows. The highlight is not scaled up where the points miss
// most of what is above the horizon. `open`: the diffuse light without shadows.
vec3 emitter_light(gpu_light light, Lit lit, EmitterSum sum, out vec3 open)
{
    open = vec3(0.0);
    if (!(sum.weight > 0.0))
        return open;
    float factor = emitter_form_factor(light, lit.p, vec3(lit.error), lit.ns);
    float sampled = light.area_share * sum.weight;
    vec3 radiance = min(light.color, vec3(LIGHT_MAX));
    vec3 diffuse = lit.diffuse * (factor * (sum.visible / sum.weight));
    vec3 highlight = sum.highlight * (light.area_share * min(factor / sampled, 1.0));
    open = radiance * (lit.diffuse * factor);
    return radiance * (diffuse + highlight);
}

#endif

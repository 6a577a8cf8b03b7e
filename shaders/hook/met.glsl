// What a ray has met, as stages behind `closest` have it: the surface on the ray's side, as functions of users are
// given it, and what its material does with light there.
#ifndef HOOK_MET_GLSL
#define HOOK_MET_GLSL

#include "../bind/crossing.glsl"
#include "../bind/hook.glsl"
#include "../bind/optics.glsl"
#include "../bind/queues.glsl"

struct Met {
    uint slot;
    Ray ray; // as it arrives: its weight is what counts of the surface's light
    Hit hit;
    Surface s;
    gpu_material m;
    Crossing c;
};

// The hit of ray `id`, and what user's functions are told of the ray. `alive`: it is not another invocation's.
// `counts`: what is traversed for it is of the pixel's costs.
Met fetch_met(uint id, bool alive, bool counts, inout uint status)
{
    Met met;
    met.ray = fetch_ray(id, met.slot);
#ifdef HOOKS
    count_camera(0u, is_primary());
#endif
    met.hit = fetch_hit(id);
    met.ray.weight *= medium_transmittance(met.ray.media, met.hit.t);
    met_origin = met.ray.origin;
    met_dir = met.ray.dir;
    met.s = fetch_surface(met.hit);
    met.m = fetch_material(met.s.material);
    bool inside = face_ray(met.s, met.ray.dir);
    met.c = cross_surface(alive && counts ? met.slot : HIT_NONE, met.ray, met.hit, met.s, met.m, inside, status);
    if (SPEC_MINIFICATION != 0u) {
        met.ray.way += met.hit.t;
        take_footprint(met.s, met.ray.dir, texel_area(slot_pixel(met.slot), met.ray.way));
    }
    hook_ray = met.ray;
#ifdef HOOKS
    hook_pixel = slot_pixel(met.slot);
    hook_hit = met.hit;
    hook_media = met.c.before;
#endif
    return met;
}

#ifdef HOOKS
void change_surface(inout Surface s)
{
    Surface changed = s;
    begin_hook();
    surface(changed);
    end_hook(true);
    vec3 sum = changed.ns + changed.color + vec3(changed.u, changed.v, changed.color_alpha);
    hook_lost = any(isnan(sum)) || any(isinf(sum));
    s.ns = normalize_or(changed.ns, s.ns);
    s.color = changed.color;
    s.color_alpha = changed.color_alpha;
    s.u = changed.u;
    s.v = changed.v;
}
#endif

// What the material does with light; met.s then has its last normal.
Optics look_at(inout Met met)
{
#ifdef HOOKS
    if ((SPEC_HOOKS & HOOK_SURFACE) != 0u)
        change_surface(met.s);
#endif
    Optics o = surface_optics(met.s, met.m, met.ray.dir, met.c.eta);
    if (dot(met.s.ns, met.ray.dir) > 0.0)
        met.s.ns = met.s.ng;
    return o;
}

#endif

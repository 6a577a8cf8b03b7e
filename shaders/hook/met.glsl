// What a ray has met: the hit, its surface on the side that the ray comes from, the media on both sides of it, and
// what its material does with light. The stages hit, aov and shade share it.
#ifndef HOOK_MET_GLSL
#define HOOK_MET_GLSL

#include "../bind/crossing.glsl"
#include "../bind/hook.glsl"
#include "../bind/optics.glsl"
#include "../bind/queues.glsl"

layout(set = 0, binding = BIND_HOOK_ROWS, std430) buffer HookRowBuffer { uvec4 hook_rows[]; };
layout(set = 0, binding = BIND_HOOK_ROWS, std430) buffer WideHookBuffer { u64vec2 wide_hook_rows[]; };
layout(set = 0, binding = BIND_HOOK_TEXELS) uniform usamplerBuffer hook_texels;

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

// Rows that a hit has of what the user's functions make of it.
const uint SURFACE_ROWS = (SPEC_HOOKS & HOOK_SURFACE) != 0u ? HOOK_SURFACE_ROWS : 0u;
const uint HOOK_ROWS = SURFACE_ROWS + ((SPEC_HOOKS & HOOK_SHADE) != 0u ? HOOK_LIGHT_ROWS : 0u);

void store_hook_row(uint row, vec4 value)
{
    if (SPEC_WIDE_ROWS != 0u)
        wide_hook_rows[row] = wide_row(floatBitsToUint(value));
    else
        hook_rows[row] = floatBitsToUint(value);
}

vec4 fetch_hook_row(uint row)
{
    if (SPEC_LOAD_PATH == LOAD_TEXEL)
        return uintBitsToFloat(texelFetch(hook_texels, int(row)));
    return uintBitsToFloat(hook_rows[row]);
}

// What surface() has changed of the hit of ray `id`. `lost`: it gave no number.
void store_changed(uint id, Surface s, bool lost)
{
    store_hook_row(id * HOOK_ROWS, vec4(s.ns, s.u));
    store_hook_row(id * HOOK_ROWS + 1u, vec4(s.color, s.v));
    store_hook_row(id * HOOK_ROWS + 2u, vec4(s.color_alpha, float(lost), 0.0, 0.0));
}

void fetch_changed(uint id, inout Surface s, out bool lost)
{
    vec4 r0 = fetch_hook_row(id * HOOK_ROWS), r1 = fetch_hook_row(id * HOOK_ROWS + 1u);
    vec4 r2 = fetch_hook_row(id * HOOK_ROWS + 2u);
    s.ns = r0.xyz;
    s.u = r0.w;
    s.color = r1.xyz;
    s.v = r1.w;
    s.color_alpha = r2.x;
    lost = r2.y != 0.0;
}

// What shade() has said.
void store_hook_light(uint id, vec3 light)
{
    store_hook_row(id * HOOK_ROWS + SURFACE_ROWS, vec4(light, 0.0));
}

vec3 fetch_hook_light(uint id)
{
    return fetch_hook_row(id * HOOK_ROWS + SURFACE_ROWS).xyz;
}

bool is_catcher(Met met)
{
    return SPEC_CATCHERS != 0u && (met.m.flags & MATERIAL_CATCHER) != 0u;
}

// A shadow catcher reflects nothing: light goes straight on, see caught_share.
void make_catcher(inout Optics o)
{
    o.diffuse = vec3(1.0);
    o.ambient = vec3(0.0);
    o.highlight = vec3(0.0);
    o.emission = vec3(0.0);
    o.reflected = vec3(0.0);
    o.refracted = vec3(0.0);
    o.straight = 1.0;
    o.unlit = false;
    o.metal_rough = false;
}

// What the material does with light; met.s then has its last normal.
Optics look_at(inout Met met)
{
    Optics o = surface_optics(met.s, met.m, met.ray.dir, met.c.eta);
    if (dot(met.s.ns, met.ray.dir) > 0.0)
        met.s.ns = met.s.ng;
    if (is_catcher(met))
        make_catcher(o);
    return o;
}

#endif

// A hit with all that shading needs: its surface, turned to the side that the ray comes from, the
// media on both sides, and what its material does with light. The stages hit, aov and shade share
// it.
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
    Ray ray; // as it arrives: its weight is that of the surface's light in the picture
    Hit hit;
    Surface s;
    bool inside; // it is met from inside; set by fetch_met
    gpu_material m;
    Crossing c;
};

// Sets what the user's functions can read about the ray.
void tell_functions(Met met)
{
    hook_ray = met.ray;
#ifdef HOOKS
    hook_pixel = slot_pixel(met.slot);
    hook_hit = met.hit;
    hook_shade = met.s.shade_index;
    hook_media = met.c.before;
#endif
}

// Fetches the hit of ray `id`, and sets what the user's functions can read. `alive`: false where
// the invocation has no ray of its own. `counts`: rays traced for the media add to the pixel's
// costs.
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
    met.inside = face_ray(met.s, met.ray.dir);
    met.c = cross_surface(alive && counts ? met.slot : HIT_NONE, met.ray, met.hit, met.s, met.m,
                          met.inside, status);
    if (SPEC_MINIFICATION != 0u) {
        met.ray.way += met.hit.t;
        take_footprint(met.s, met.ray.dir, texel_area(slot_pixel(met.slot), met.ray.way));
    }
    tell_functions(met);
    return met;
}

// Numbers of rows per hit for what the user's functions return.
const uint SURFACE_ROWS = (SPEC_HOOKS & HOOK_SURFACE) != 0u ? HOOK_SURFACE_ROWS : 0u;
const uint HOOK_ROWS = SURFACE_ROWS + ((SPEC_HOOKS & HOOK_SHADE) != 0u ? HOOK_LIGHT_ROWS : 0u);

void store_hook_words(uint row, uvec4 value)
{
    if (SPEC_WIDE_ROWS != 0u)
        wide_hook_rows[row] = wide_row(value);
    else
        hook_rows[row] = value;
}

void store_hook_row(uint row, vec4 value)
{
    store_hook_words(row, floatBitsToUint(value));
}

uvec4 fetch_hook_words(uint row)
{
    if (SPEC_LOAD_PATH == LOAD_TEXEL)
        return texelFetch(hook_texels, int(row));
    return hook_rows[row];
}

vec4 fetch_hook_row(uint row)
{
    return uintBitsToFloat(fetch_hook_words(row));
}

// Stores what surface() made of the hit of ray `id`. `lost`: some of it is NaN or infinite.
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

// Stores the light that shade() returned.
void store_hook_light(uint id, vec3 light)
{
    store_hook_row(id * HOOK_ROWS + SURFACE_ROWS, vec4(light, 0.0));
}

vec3 fetch_hook_light(uint id)
{
    return fetch_hook_row(id * HOOK_ROWS + SURFACE_ROWS).xyz;
}

// ---- What HIT_PART_FETCH leaves to HIT_PART_CALL ----

// The invocation's first row, behind those of hits. False: there is no room for it.
bool met_row(out uint row)
{
    uint at = gl_WorkGroupID.x * SPEC_GROUP_SIZE + gl_LocalInvocationID.x;
    uint first = chunk.ray_capacity * HOOK_ROWS;
    bool has_room = at < (hook_rows.length() - first) / MET_ROWS;
    row = first + (has_room ? at * MET_ROWS : 0u);
    return has_room;
}

void store_met(uint row, Met met)
{
    Surface s = met.s;
    store_hook_words(row, uvec4(floatBitsToUint(met.ray.origin), met.slot));
    store_hook_words(row + 1u, uvec4(floatBitsToUint(met.ray.dir), met.ray.steps));
    store_hook_words(row + 2u, met.c.before);
    store_hook_row(row + 3u, vec4(s.p, s.u));
    store_hook_row(row + 4u, vec4(s.error, s.v));
    store_hook_row(row + 5u, vec4(s.ng, s.color_alpha));
    store_hook_row(row + 6u, vec4(s.ns, 0.0));
    store_hook_words(row + 7u, uvec4(floatBitsToUint(s.e1), s.shade_index));
    store_hook_words(row + 8u, uvec4(floatBitsToUint(s.e2), s.instance));
    store_hook_words(row + 9u, uvec4(floatBitsToUint(s.footprint), s.material));
    uint sides = uint(s.on_sphere) | uint(s.turned) << 1;
    store_hook_words(row + 10u, uvec4(floatBitsToUint(s.color), sides));
}

// Fills in what the user's functions can read, and nothing else of `met`.
Met fetch_stored_met(uint row)
{
    Met met;
    uvec4 r0 = fetch_hook_words(row), r1 = fetch_hook_words(row + 1u);
    met.ray.origin = row_vec3(r0);
    met.slot = r0.w;
    met.ray.dir = row_vec3(r1);
    met.ray.steps = r1.w;
    met.c.before = fetch_hook_words(row + 2u);
    vec4 p = fetch_hook_row(row + 3u), error = fetch_hook_row(row + 4u), ng = fetch_hook_row(row + 5u);
    uvec4 e1 = fetch_hook_words(row + 7u), e2 = fetch_hook_words(row + 8u);
    uvec4 footprint = fetch_hook_words(row + 9u), color = fetch_hook_words(row + 10u);
    met.s.p = p.xyz;
    met.s.u = p.w;
    met.s.error = error.xyz;
    met.s.v = error.w;
    met.s.ng = ng.xyz;
    met.s.color_alpha = ng.w;
    met.s.ns = fetch_hook_row(row + 6u).xyz;
    met.s.e1 = row_vec3(e1);
    met.s.shade_index = e1.w;
    met.s.e2 = row_vec3(e2);
    met.s.instance = e2.w;
    met.s.footprint = row_vec3(footprint);
    met.s.material = footprint.w;
    met.s.color = row_vec3(color);
    met.s.on_sphere = (color.w & 1u) != 0u;
    met.s.turned = (color.w & 2u) != 0u;
    return met;
}

void store_optics(uint row, Optics o)
{
    uint flags = uint(o.thin) | uint(o.unlit) << 1 | uint(o.metal_rough) << 2;
    store_hook_row(row + 11u, vec4(o.diffuse, o.straight));
    store_hook_row(row + 12u, vec4(o.ambient, o.shininess));
    store_hook_row(row + 13u, vec4(o.highlight, o.alpha));
    store_hook_row(row + 14u, vec4(o.emission, o.eta));
    store_hook_words(row + 15u, uvec4(floatBitsToUint(o.reflected), flags));
    store_hook_row(row + 16u, vec4(o.refracted, 0.0));
}

Optics fetch_optics(uint row)
{
    Optics o;
    vec4 r0 = fetch_hook_row(row + 11u), r1 = fetch_hook_row(row + 12u);
    vec4 r2 = fetch_hook_row(row + 13u), r3 = fetch_hook_row(row + 14u);
    uvec4 r4 = fetch_hook_words(row + 15u);
    o.diffuse = r0.xyz;
    o.straight = r0.w;
    o.ambient = r1.xyz;
    o.shininess = r1.w;
    o.highlight = r2.xyz;
    o.alpha = r2.w;
    o.emission = r3.xyz;
    o.eta = r3.w;
    o.reflected = row_vec3(r4);
    o.refracted = fetch_hook_row(row + 16u).xyz;
    o.thin = (r4.w & 1u) != 0u;
    o.unlit = (r4.w & 2u) != 0u;
    o.metal_rough = (r4.w & 4u) != 0u;
    return o;
}

bool is_catcher(Met met)
{
    return SPEC_CATCHERS != 0u && (met.m.flags & MATERIAL_CATCHER) != 0u;
}

// Makes a shadow catcher's optics: it reflects nothing, and light goes straight on (see
// caught_share).
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

// The material's interaction with light. Also sets met.s to its final normal.
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

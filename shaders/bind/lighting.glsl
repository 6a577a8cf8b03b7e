// Light that reaches a surface straight from the lights, with shadows.
#ifndef BIND_LIGHTING_GLSL
#define BIND_LIGHTING_GLSL

#include "light.glsl"
#include "optics.glsl"
#include "picture.glsl"

// What the shadow ray of a light meets. Without trees: in the ranges so far.
Hit find_blocker(uint slot, uint light, vec3 origin, vec3 to_light, float distance, Hit from)
{
    Hit blocker;
    if (SPEC_BRUTE == BRUTE_OFF) {
        blocker = traverse(TRAVERSE_SHADOW, origin, to_light, 0.0, distance, frame.root,
                           from.instance, from.primitive);
        add_cost(slot, RAY_SHADOW);
        return blocker;
    }
    uint at = slot * frame.light_count + light;
    blocker = make_hit(distance);
    if (SPEC_BRUTE == BRUTE_SHADE || chunk.begin == 0u) {
        gpu_passed before = passed[at];
        blocker.filter_depth = ivec3(uvec3(before.red, before.green, before.blue));
        blocker.primitive = before.blocked != 0u ? 0u : HIT_NONE;
    }
    if (SPEC_BRUTE == BRUTE_SHADOW) {
        traverse_runs(TRAVERSE_SHADOW, origin, to_light, 0.0, chunk.first_run, chunk.begin,
                      from.instance, from.primitive, blocker);
        add_cost(slot, RAY_SHADOW);
        passed[at] = gpu_passed(uint(blocker.filter_depth.r), uint(blocker.filter_depth.g),
                                uint(blocker.filter_depth.b), uint(blocker.primitive != HIT_NONE));
    }
    return blocker;
}

// How much of a light passes to `p`: 1 less opaque things in between, times the filters.
vec3 light_share(uint slot, uint light, vec3 p, vec3 error, vec3 side, vec3 to_light,
                 float distance, Hit from, inout uint status)
{
    if (SPEC_SHADOWS == 0u)
        return vec3(1.0);
    vec3 origin = offset_origin(p, error, side);
    Hit blocker = find_blocker(slot, light, origin, to_light, distance, from);
    status |= blocker.status;
    if (blocker.primitive != HIT_NONE)
        return vec3(0.0);
    if (SPEC_FILTERS == 0u)
        return vec3(1.0);
    return exp2(vec3(blocker.filter_depth) * (-1.0 / SHADOW_DEPTH_SCALE));
}

// Light from all lights, towards the eye. The phase BRUTE_SHADOW has one light.
vec3 local_light(uint slot, Surface s, Optics o, vec3 view, Hit hit, inout uint shadow_rays,
                 inout uint status)
{
    vec3 sum = o.emission + o.ambient * frame.ambient;
    if (SPEC_LIGHTS == 0u)
        return sum;
    float cos_view = max(dot(view, s.ns), 0.0);
    uint i = SPEC_BRUTE == BRUTE_SHADOW ? chunk.light : 0u;
    do {
        vec3 to_light, arriving;
        float distance;
        bool lit = i < frame.light_count && light_at(i, s.p, to_light, distance, arriving);
        float cos_light = dot(to_light, s.ns);
        lit = lit && cos_light > 0.0 && dot(to_light, s.ng) > 0.0;
        vec3 reflected = o.diffuse * cos_light;
        if (SPEC_HIGHLIGHTS != 0u) {
            vec3 middle = normalize_or(to_light + view, s.ns);
            float cos_half = clamp(dot(middle, s.ns), 0.0, 1.0);
            reflected += o.metal_rough
                             ? o.highlight * cos_light *
                                   ggx_highlight(cos_half, cos_light, cos_view, o.alpha)
                             : o.highlight * blinn_highlight(cos_half, o.shininess);
        }
        lit = lit && max(reflected.r, max(reflected.g, reflected.b)) > 0.0;
        if (lit) {
            vec3 share =
                light_share(slot, i, s.p, s.error, s.ng, to_light, distance, hit, status);
            sum += reflected * arriving * share;
            if (SPEC_SHADOWS != 0u)
                shadow_rays++;
        }
        i++;
    } while (SPEC_BRUTE != BRUTE_SHADOW && i < frame.light_count);
    if (SPEC_BRUTE != BRUTE_SHADOW && i < frame.light_count)
        status |= STATUS_UNFINISHED_LOOP;
    return sum;
}

#endif

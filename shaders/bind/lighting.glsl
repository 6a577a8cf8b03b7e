// Light that reaches a surface straight from the lights, with shadows.
#ifndef BIND_LIGHTING_GLSL
#define BIND_LIGHTING_GLSL

#include "light.glsl"
#include "optics.glsl"
#include "picture.glsl"

// What the shadow ray of a turn meets. Without trees: in the ranges so far.
Hit find_blocker(uint slot, uint turn, vec3 origin, vec3 to_light, float distance, Hit from)
{
    Hit blocker;
    if (SPEC_BRUTE == BRUTE_OFF) {
        blocker = traverse(TRAVERSE_SHADOW, origin, to_light, 0.0, distance, frame.root,
                           from.instance, from.primitive);
        add_cost(slot, RAY_SHADOW);
        return blocker;
    }
    uint at = slot * (frame.light_count * turns_each()) + turn;
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

// How much of a light passes to the surface: 1 less opaque things in between, times the filters.
vec3 light_share(uint slot, uint turn, Surface s, vec3 to_light, float distance, Hit from,
                 inout uint status)
{
    if (SPEC_SHADOWS == 0u)
        return vec3(1.0);
    vec3 origin = offset_origin(s.p, s.error, s.ng);
    Hit blocker = find_blocker(slot, turn, origin, to_light, distance, from);
    status |= blocker.status;
    if (blocker.primitive != HIT_NONE)
        return vec3(0.0);
    if (SPEC_FILTERS == 0u)
        return vec3(1.0);
    return exp2(vec3(blocker.filter_depth) * (-1.0 / SHADOW_DEPTH_SCALE));
}

// What the points of a flat emitter add up to. Its diffuse light is that of the whole polygon, of
// which the points only tell the visible share, weighted by what each of them would send.
struct EmitterSum {
    float weight;  // cos cos / distance^2
    vec3 visible;  // the same, times the share that passes
    vec3 highlight;
};

const EmitterSum EMITTER_NOTHING = EmitterSum(0.0, vec3(0.0), vec3(0.0));

// The highlight is not scaled up where points miss most of what is above the horizon.
vec3 emitter_light(gpu_light light, Surface s, Optics o, EmitterSum sum)
{
    if (!(sum.weight > 0.0))
        return vec3(0.0);
    float factor = emitter_form_factor(light, s.p, s.ns);
    float sampled = light.area_share * sum.weight;
    vec3 diffuse = o.diffuse * (factor * (sum.visible / sum.weight));
    vec3 highlight = sum.highlight * (light.area_share * min(factor / sampled, 1.0));
    return min(light.color, vec3(LIGHT_MOST)) * (diffuse + highlight);
}

// Light from all lights, towards the eye. One loop over all points of all lights, since a loop within
// a loop would keep the lanes of a subgroup waiting for each other. The phase BRUTE_SHADOW has one
// turn.
vec3 local_light(uint slot, Surface s, Optics o, vec3 view, Hit hit, inout uint shadow_rays,
                 inout uint status)
{
    vec3 sum = o.emission + o.ambient * frame.ambient;
    if (SPEC_LIGHTS == 0u)
        return sum;
    float cos_view = max(dot(view, s.ns), 0.0);
    uint each = turns_each();
    uint turn_count = frame.light_count * each;
    uint turn = SPEC_BRUTE == BRUTE_SHADOW ? chunk.light : 0u;
    EmitterSum emitter = EMITTER_NOTHING;
    do {
        uint index = (SPEC_LIGHTS & LIGHT_FLAT_BITS) != 0u ? turn >> uint(findMSB(each)) : turn;
        uint point = turn & (each - 1u);
        LightTurn at;
        bool lit = turn < turn_count && light_at(fetch_light(index), point, s.p, at);
        float cos_light = dot(at.to_light, s.ns);
        bool faces = lit && cos_light > 0.0;
        lit = faces && dot(at.to_light, s.ng) > 0.0;
        vec3 highlight = vec3(0.0);
        vec3 reflected = o.diffuse * cos_light;
        if (SPEC_HIGHLIGHTS != 0u) {
            vec3 middle = normalize_or(at.to_light + view, s.ns);
            float cos_half = clamp(dot(middle, s.ns), 0.0, 1.0);
            highlight = o.metal_rough
                            ? o.highlight * cos_light *
                                  ggx_highlight(cos_half, cos_light, cos_view, o.alpha)
                            : o.highlight * blinn_highlight(cos_half, o.shininess);
            reflected += highlight;
        }
        lit = lit && max(reflected.r, max(reflected.g, reflected.b)) > 0.0;
        vec3 share = vec3(0.0);
        if (lit) {
            share = light_share(slot, turn, s, at.to_light, at.distance, hit, status);
            if (SPEC_SHADOWS != 0u)
                shadow_rays++;
        }
        bool is_last = true; // turn of its light
        if ((SPEC_LIGHTS & LIGHT_FLAT_BITS) != 0u && turn < turn_count && is_flat(at.light)) {
            is_last = point == each - 1u;
            float weight = faces ? cos_light * at.strength : 0.0;
            emitter.weight += weight;
            emitter.visible += share * weight;
            emitter.highlight += lit ? highlight * share * at.strength : vec3(0.0);
            if (is_last && SPEC_BRUTE != BRUTE_SHADOW) {
                sum += emitter_light(at.light, s, o, emitter);
                emitter = EMITTER_NOTHING;
            }
        } else if (lit) {
            sum += reflected * at.arriving * share;
        }
        turn += is_last ? each - point : 1u;
    } while (SPEC_BRUTE != BRUTE_SHADOW && turn < turn_count);
    if (SPEC_BRUTE != BRUTE_SHADOW && turn < turn_count)
        status |= STATUS_UNFINISHED_LOOP;
    return sum;
}

#endif

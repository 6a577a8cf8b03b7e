// Light that reaches a surface straight from the lights, with shadows.
#ifndef BIND_LIGHTING_GLSL
#define BIND_LIGHTING_GLSL

#include "filter.glsl"
#include "light.glsl"
#include "optics.glsl"
#include "picture.glsl"
#include "probe.glsl"
#include "terminator.glsl"

// Where light is received: what all shadow rays of a hit have in common.
struct Receiver {
    vec3 lift;       // from the hit point to where shadow rays start, see smooth_lift
    vec3 absorption; // of the media around it
    uint instance, primitive;
};

// What a shadow ray meets.
Hit find_blocker(uint slot, vec3 origin, vec3 to_light, float distance, uint skip_instance,
                 uint skip_primitive)
{
    Hit blocker = traverse(TRAVERSE_SHADOW, origin, to_light, 0.0, distance, frame.root,
                           skip_instance, skip_primitive);
    add_cost(slot, RAY_SHADOW);
    return blocker;
}

// How much of a light passes to the surface: 1 less opaque things in between, times the filters.
// What is lifted off the triangle may be met by light from below the triangle's plane, which then
// must pass beside the triangle itself.
vec3 light_share(uint slot, uint turn, Surface s, Receiver at, LightTurn light, bool above,
                 inout uint status)
{
    if (SPEC_SHADOWS == 0u)
        return vec3(1.0);
    vec3 origin = offset_origin(s.p + at.lift, s.error, s.ng);
    vec3 to_light = light.to_light;
    float distance = light.distance;
    if (SPEC_TERMINATOR != 0u && at.lift != vec3(0.0) && distance < FLOAT_LARGEST) {
        vec3 way = s.p + to_light * distance - origin;
        distance = length(way);
        to_light = way / distance;
    }
    Hit blocker = find_blocker(slot, origin, to_light, distance, at.instance,
                               above ? at.primitive : HIT_NONE);
    status |= blocker.status;
    if (SPEC_PROBE != 0u)
        probe_blocker(turn, origin, to_light, distance, at.instance,
                      above ? at.primitive : HIT_NONE, blocker);
    if (blocker.primitive != HIT_NONE)
        return vec3(0.0);
    if (SPEC_FILTERS == 0u)
        return vec3(1.0);
    ivec3 depth = blocker.filter_depth;
    if (SPEC_FILTER_DETAIL != 0u && SPEC_ABSORPTION != 0u)
        depth = max(depth + absorption_depth(at.absorption, distance < FLOAT_LARGEST ? distance : 0.0), ivec3(0));
    return exp2(vec3(depth) * (-1.0 / SHADOW_DEPTH_SCALE));
}

// What the points of a flat emitter add up to. Its diffuse light is that of the whole polygon, of
// which the points only tell the visible share, weighted by what each of them would send.
struct EmitterSum {
    float weight;  // cos cos / distance^2
    vec3 visible;  // the same, times the share that passes
    vec3 highlight;
};

const EmitterSum EMITTER_NOTHING = EmitterSum(0.0, vec3(0.0), vec3(0.0));

// The highlight is not scaled up where points miss most of what is above the horizon. `open`: the
// diffuse light without shadows.
vec3 emitter_light(gpu_light light, Surface s, Optics o, EmitterSum sum, out vec3 open)
{
    open = vec3(0.0);
    if (!(sum.weight > 0.0))
        return open;
    float factor = emitter_form_factor(light, s.p, s.error, s.ns);
    float sampled = light.area_share * sum.weight;
    vec3 radiance = min(light.color, vec3(LIGHT_MOST));
    vec3 diffuse = o.diffuse * (factor * (sum.visible / sum.weight));
    vec3 highlight = sum.highlight * (light.area_share * min(factor / sampled, 1.0));
    open = radiance * (o.diffuse * factor);
    return radiance * (diffuse + highlight);
}

// What all turns of a hit have in common.
struct Lit {
    Receiver receiver;
    vec3 view;
    float cos_view;
    bool lifted;
};

// One turn of the loops over lights and their points. What a point of a flat emitter adds goes into
// `emitter`, all else into `sum`; `open`: what it would add without shadows.
void add_turn(uint slot, uint turn, gpu_light light, uint point, Surface s, Optics o, Lit lit,
              inout EmitterSum emitter, inout vec3 sum, inout vec3 open, inout uint shadow_rays,
              inout uint status)
{
    LightTurn at;
    bool arrives = light_at(light, point, s.p, at);
    float cos_light = dot(at.to_light, s.ns);
    bool faces = arrives && cos_light > 0.0;
    bool above = dot(at.to_light, s.ng) > 0.0;
    bool wanted = faces && (above || lit.lifted);
    vec3 highlight = vec3(0.0);
    vec3 reflected = o.diffuse * cos_light;
    if (SPEC_HIGHLIGHTS != 0u) {
        vec3 middle = normalize_or(at.to_light + lit.view, s.ns);
        float cos_half = clamp(dot(middle, s.ns), 0.0, 1.0);
        highlight = o.metal_rough ? o.highlight * cos_light *
                                        ggx_highlight(cos_half, cos_light, lit.cos_view, o.alpha)
                                  : o.highlight * blinn_highlight(cos_half, o.shininess);
        reflected += highlight;
    }
    wanted = wanted && !(reflected.r + reflected.g + reflected.b <= 0.0); // NaN is: it must be seen
    vec3 share = vec3(0.0);
    if (wanted) {
        share = light_share(slot, turn, s, lit.receiver, at, above, status);
        if (SPEC_SHADOWS != 0u)
            shadow_rays++;
        if (SPEC_PROBE != 0u && SPEC_SHADOWS != 0u)
            probe_share(share);
    }
    if ((SPEC_LIGHTS & LIGHT_FLAT_BITS) != 0u && is_flat(light)) {
        float weight = faces ? cos_light * at.strength : 0.0;
        emitter.weight += weight;
        emitter.visible += share * weight;
        emitter.highlight += wanted ? highlight * share * at.strength : vec3(0.0);
    } else if (wanted) {
        sum += reflected * at.arriving * share;
        if (SPEC_CATCHERS != 0u)
            open += reflected * at.arriving;
    }
}

// Light from all lights, towards the eye. The inner loop is over the points of a flat emitter; all
// rays go through the same lights and points, so none waits for another. `media`: around the
// surface, on its side. `open`: what the lights would add without shadows.
vec3 local_light(uint slot, Surface s, Optics o, vec3 view, Hit hit, uvec4 media,
                 out vec3 open, inout uint shadow_rays, inout uint status)
{
    vec3 sum = o.emission + o.ambient * frame.ambient;
    open = vec3(0.0);
    if (SPEC_LIGHTS == 0u)
        return sum;
    Lit lit;
    lit.receiver = Receiver(smooth_lift(s), surrounding_absorption(media), hit.instance,
                            hit.primitive);
    lit.view = view;
    lit.cos_view = max(dot(view, s.ns), 0.0);
    lit.lifted = SPEC_TERMINATOR != 0u && lit.receiver.lift != vec3(0.0);
    const bool flats = (SPEC_LIGHTS & LIGHT_FLAT_BITS) != 0u;
    uint each = turns_each();
    uint turn = 0u, index = 0u;
    if (frame.light_count == 0u)
        return sum;
    do {
        gpu_light light = fetch_light(index);
        uint point = turn - index * each;
        uint points = flats && is_flat(light) ? each : 1u;
        EmitterSum emitter = EMITTER_NOTHING;
        bool more = false;
        do {
            add_turn(slot, turn, light, point, s, o, lit, emitter, sum, open, shadow_rays, status);
            point++;
            turn++;
            more = flats && point < points;
        } while (more);
        if (more)
            status |= STATUS_UNFINISHED_LOOP;
        if (flats && is_flat(light)) {
            vec3 emitter_open;
            sum += emitter_light(light, s, o, emitter, emitter_open);
            open += emitter_open;
        }
        index++;
        turn = index * each;
    } while (index < frame.light_count);
    if (index < frame.light_count)
        status |= STATUS_UNFINISHED_LOOP;
    return sum;
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

// How much of what lies behind it a catcher shows: what light it gets of what it would get without
// shadows. Where no light comes anyway it shows all.
vec3 caught_share(vec3 light, vec3 open)
{
    vec3 share = clamp(light / max(open, vec3(1e-30)), vec3(0.0), vec3(1.0));
    return mix(vec3(1.0), share, greaterThan(open, vec3(1e-30)));
}

#endif

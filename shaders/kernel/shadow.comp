// Adds the light of one light, or of up to SPEC_LIGHTS_EACH lights, with shadows, to the lit hits of a
// generation.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../bind/stage.glsl"
#include "../bind/queues.glsl"
#include "../bind/arrival.glsl"
#include "../bind/packet.glsl"
#include "../bind/probe.glsl"

#ifdef HOOKS
#include "../hook/declare.glsl"
#endif

Lit lit_of[SPEC_PACKET_RAYS];

// The share of the light that reaches the surface: 0 behind something opaque, else the product of
// the filters.
vec3 light_share(uint r, bool wanted, Lit lit, inout uint status)
{
    Hit blocker = packet_hits[r];
    if (SPEC_SHADOWS == 0u)
        return vec3(1.0);
    if (SPEC_COUNT != 0u && wanted) {
        uint slot;
        fetch_ray(lit.id, slot);
        add_cost(slot, RAY_SHADOW);
    }
    status |= wanted ? blocker.status : 0u;
    return passing_share(blocker, lit.absorption);
}

Arrival arrival_of[SPEC_PACKET_RAYS];

// Whether the user's shape blocks the shadow ray, found by shape.comp. Such a ray is not traced
// through the trees.
bool in_shape_shadow[SPEC_PACKET_RAYS];

uint light_index; // of the current light

void face_light(uint r, bool alive, gpu_light light, uint item, uint point)
{
    Lit lit = lit_of[r];
    Arrival a = arrive(alive, lit, light, point);
    const bool has_shape = (SPEC_HOOKS & HOOK_INTERSECT) != 0u && SPEC_SHADOWS != 0u;
    in_shape_shadow[r] = has_shape && a.wanted && is_in_shape_shadow(item, point);
    packet_alive[r] = a.wanted && !in_shape_shadow[r];
    packet_origin[r] = lit.origin;
    packet_dir[r] = a.dir;
    packet_t_max[r] = a.distance;
    packet_skip[r] = uvec2(lit.skip_instance, a.above ? lit.skip_primitive : HIT_NONE);
    arrival_of[r] = a;
}

EmitterSum emitter_of[SPEC_PACKET_RAYS];
vec3 sum_of[SPEC_PACKET_RAYS], open_of[SPEC_PACKET_RAYS]; // of the current light
// With several lights: the ray's sum so far, and of a shadow catcher its light so far without
// shadows. With one: what it adds to both, which are read when they are stored, as values that are
// kept during traversal take time.
vec3 own_of[SPEC_PACKET_RAYS], seen_of[SPEC_PACKET_RAYS];
// Number of shadow rays; with several lights a bit for each.
uint rays_of[SPEC_PACKET_RAYS], status_of[SPEC_PACKET_RAYS];

void add_arrival(uint r, gpu_light light, uint point)
{
    Arrival a = arrival_of[r];
    if (in_shape_shadow[r])
        put_shape_in(packet_hits[r], packet_t_max[r], vec2(0.0));
    vec3 share = light_share(r, a.wanted, lit_of[r], status_of[r]);
    share = a.wanted ? share : vec3(0.0);
    if (SPEC_PROBE != 0u && SPEC_SHADOWS != 0u && a.wanted)
        probe_shadow_ray(lit_of[r].id, light_index * turns_each() + point, packet_origin[r],
                         packet_dir[r], packet_t_max[r], packet_skip[r], packet_hits[r], share);
    uint place = SPEC_LIGHTS_EACH > 1u ? light_index - chunk.light : 0u;
    rays_of[r] += uint(a.wanted) << place;
    if ((SPEC_LIGHTS & LIGHT_FLAT_BITS) != 0u && is_flat(light)) {
        float weight = a.faces ? a.cos_light * a.strength : 0.0;
        emitter_of[r].weight += weight;
        emitter_of[r].visible += share * weight;
        emitter_of[r].highlight += a.wanted ? a.highlight * share * a.strength : vec3(0.0);
    } else if (a.wanted) {
        sum_of[r] += a.reflected * a.arriving * share;
        if (SPEC_CATCHERS != 0u)
            open_of[r] += a.reflected * a.arriving;
    }
}

bool is_catcher(uint r)
{
    return SPEC_CATCHERS != 0u && (lit_of[r].flags & LIT_CATCHER) != 0u;
}

vec3 fetch_seen(uint r)
{
    return uintBitsToFloat(hit_rows[lit_of[r].id * HIT_ROWS].xyz);
}

// Adds the light of all points of the current light to the ray's sum.
void add_light(uint r, gpu_light light)
{
    vec3 sum = sum_of[r], open = open_of[r];
    if ((SPEC_LIGHTS & LIGHT_FLAT_BITS) != 0u && is_flat(light)) {
        vec3 emitter_open;
        sum += emitter_light(light, lit_of[r], emitter_of[r], emitter_open);
        open += emitter_open;
    }
    own_of[r] = SPEC_LIGHTS_EACH > 1u ? own_of[r] + sum : sum;
    if (SPEC_CATCHERS != 0u)
        seen_of[r] = SPEC_LIGHTS_EACH > 1u ? seen_of[r] + open : open;
}

void store_own(uint r)
{
    uint id = lit_of[r].id;
    vec4 own = fetch_sum(id);
    store_sum(id, SPEC_LIGHTS_EACH > 1u ? own_of[r] : own.rgb + own_of[r], floatBitsToUint(own.w));
    if (is_catcher(r))
        hit_rows[id * HIT_ROWS].xyz =
            floatBitsToUint(SPEC_LIGHTS_EACH > 1u ? seen_of[r] : fetch_seen(r) + seen_of[r]);
}

// Traces the shadow rays to all points of the current light.
void trace_shadow_rays(gpu_light light, bool alive[SPEC_PACKET_RAYS], uint item[SPEC_PACKET_RAYS])
{
    const bool flats = (SPEC_LIGHTS & LIGHT_FLAT_BITS) != 0u;
    uint points = flats && is_flat(light) ? turns_each() : 1u;
    uint point = 0u;
    bool more = false;
    EACH_RAY {
        emitter_of[r] = EmitterSum(0.0, vec3(0.0), vec3(0.0));
        sum_of[r] = open_of[r] = vec3(0.0);
    }
    do {
        EACH_RAY face_light(r, alive[r], light, item[r], point);
        if (SPEC_SHADOWS != 0u)
            traverse_packets(TRAVERSE_SHADOW, 0.0, frame.root, frame.root8,
                             light_point(light, point));
        EACH_RAY add_arrival(r, light, point);
        point++;
        more = flats && point < points;
    } while (another_iteration(more));
    if (more)
        report_status(STATUS_UNFINISHED_LOOP);
}

// Counts the rays to each light from hits that are done.
void count_shadow_rays(bool done[SPEC_PACKET_RAYS])
{
    bool more = false;
    light_index = chunk.light;
    do {
        uint rays = 0u, row = LIST_LIGHTS + (frame.light_count <= LIGHT_LISTS ? light_index : 0u);
        EACH_RAY {
            uint own = rays_of[r];
            if (SPEC_LIGHTS_EACH > 1u)
                own = own >> (light_index - chunk.light) & 1u;
            rays += done[r] ? own : 0u;
        }
        rays = add_up_lanes(rays);
        if (is_first_lane() && rays != 0u)
            atomicAdd(generations[chunk.generation].lists[row].shadow_rays, rays);
        light_index++;
        more = SPEC_LIGHTS_EACH > 1u && light_index < chunk.light + chunk.lights;
    } while (more);
    if (more)
        report_status(STATUS_UNFINISHED_LOOP);
}

void main()
{
    load_frame();
#ifdef HOOKS
    begin_functions();
#endif
    bool waited = SPEC_NUMERICS == NUMERICS_EXACT && SPEC_SETTLES != 0u && chunk.deferred != 0u;
    bool alive[SPEC_PACKET_RAYS];
    uint item[SPEC_PACKET_RAYS];
    EACH_RAY {
        item[r] = waited ? deferred_item(r) : invocation_item(r, chunk.lit_capacity);
        alive[r] = item[r] != ITEM_NONE;
        item[r] = alive[r] ? item[r] : 0u;
        uint lit = fetch_listed_lit(item[r]);
        lit_of[r] = fetch_lit(alive[r] ? lit : 0u);
        rays_of[r] = status_of[r] = 0u;
        if (SPEC_LIGHTS_EACH > 1u)
            own_of[r] = fetch_sum(lit_of[r].id).rgb;
        if (SPEC_LIGHTS_EACH > 1u && is_catcher(r))
            seen_of[r] = fetch_seen(r);
    }
    uint end = chunk.light + chunk.lights;
    light_index = chunk.light;
    bool more = false;
    do {
        gpu_light light = fetch_light(light_index);
        trace_shadow_rays(light, alive, item);
        EACH_RAY add_light(r, light);
        light_index++;
        more = SPEC_LIGHTS_EACH > 1u && light_index < end;
    } while (another_iteration(more));
    if (more)
        report_status(STATUS_UNFINISHED_LOOP);
    uint status = 0u;
    bool waits[SPEC_PACKET_RAYS], done[SPEC_PACKET_RAYS];
    EACH_RAY {
        waits[r] = alive[r] && must_wait(status_of[r]);
        done[r] = alive[r] && !waits[r];
        if (done[r]) {
            store_own(r);
            status |= status_of[r];
        }
    }
    if (has_bounds_alone())
        list_deferred_rays(waits, item);
    report_status(status);
    if (SPEC_SHADOWS != 0u)
        count_shadow_rays(done);
#ifdef HOOKS
    report_hooks();
#endif
}

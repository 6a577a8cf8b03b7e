// Finds the closest hits of a generation's rays and lists them for shading; rays that miss get the
// light of the sky.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../bind/stage.glsl"
#include "../bind/environment.glsl"
#include "../bind/media.glsl"
#include "../bind/packet.glsl"
#include "../bind/probe.glsl"
#include "../bind/queues.glsl"
#include "../bind/surface.glsl"

#ifdef HOOKS
#include "../hook/declare.glsl"
#else
ivec3 filter_detail(uint instance, uint primitive, float u, float v, float way, bool front, ivec3 own)
{
    return own;
}

float filter_end(vec3 origin, float t_max)
{
    return 0.0;
}
#define miss whit_miss
#include "../hook/miss.glsl"
#undef miss
#endif

uint ray_slot[SPEC_PACKET_RAYS], ray_id[SPEC_PACKET_RAYS], ray_kind[SPEC_PACKET_RAYS];
uvec4 ray_media_of[SPEC_PACKET_RAYS];
vec3 ray_weight[SPEC_PACKET_RAYS];

void take_ray(uint r)
{
    bool waited = SPEC_NUMERICS == NUMERICS_EXACT && SPEC_SETTLES != 0u && chunk.deferred != 0u;
    uint id = waited ? deferred_item(r) : traced_item(r);
    bool primary = is_primary(), alive = id != ITEM_NONE;
    id = alive ? id : 0u;
    alive = alive && (!primary || is_in_picture(slot_place(id)));
    uint slot;
#ifdef HOOKS
    record_for(id, alive && primary); // records dbg(x) in a user's camera()
#endif
#ifdef HOOKS
    uint traced = hook_traced;
#endif
    Ray ray = fetch_ray(id, slot);
#ifdef HOOKS
    count_camera(traced, alive && primary);
#endif
    if (SPEC_COUNT != 0u && primary && alive)
        clear_costs(slot);
    ray_slot[r] = slot;
    ray_id[r] = id;
    ray_kind[r] = ray.kind;
    ray_media_of[r] = ray.media;
    ray_weight[r] = ray.weight;
    packet_alive[r] = alive;
    packet_origin[r] = ray.origin;
    packet_dir[r] = ray.dir;
    packet_t_max[r] = FLOAT_LARGEST;
    packet_skip[r] = uvec2(ray.skip_instance, ray.skip_primitive);
}

// The `firsts` of the generation that this dispatch's rays call for.
uvec4 firsts_behind()
{
    if (is_primary())
        return uvec4(camera_ray_count(), 0u, 0u, 0u);
    return uvec4(fetch_firsts(chunk.generation) + fetch_counts(chunk.generation, LIST_RAYS), 0u, 0u);
}

uint class_of_hit(Hit hit)
{
    return SPEC_CLASSES != 1u && hit.glass ? CLASS_GLASS : CLASS_PLAIN;
}

// Stores the hit of ray `r`, or its sum where it misses. True: the hit is to be shaded.
bool leave_ray(uint r, bool alive)
{
    if ((SPEC_HOOKS & HOOK_INTERSECT) != 0u) // shape.comp has found where the ray meets it
        add_stored_shape(ray_id[r], packet_hits[r]);
    Hit hit = packet_hits[r];
    bool primary = is_primary();
    if (alive)
        add_cost(ray_slot[r], ray_kind[r]);
    alive = alive && !must_wait(hit.status);
    bool met = alive && hit.primitive != HIT_NONE;
    if (alive && primary && !is_listed() && chunk.sample_index == 0u) {
        uvec2 at = slot_place(ray_slot[r]);
        if (SPEC_PIXEL_DATA != 0u)
            ids[(at.y - chunk.band_y) * frame.width + at.x] = uvec2(hit.instance, hit.primitive);
        if (SPEC_VIEWS != 0u)
            distances[(at.y - chunk.band_y) * frame.width + at.x] =
                hit.primitive != HIT_NONE ? hit.t : uintBitsToFloat(0x7f800000u);
    }
    if (met)
        store_hit(ray_id[r], hit);
    vec3 weight = ray_weight[r] * medium_transmittance(ray_media_of[r], hit.t); // a miss: the largest float
    const bool asked = (SPEC_HOOKS & HOOK_MISS) != 0u; // miss.comp will compute the sky
    vec3 sky = asked ? weight : whit_miss(packet_dir[r]) * weight;
    if (alive && (asked || !met))
        store_sum(ray_id[r], sky, asked && !met ? SUM_MISSED : 0u);
    if (SPEC_PROBE != 0u && alive)
        probe_traced(ray_id[r], packet_origin[r], packet_dir[r], packet_skip[r], ray_weight[r], weight,
                     sky, ray_media_of[r], hit);
    return met;
}

void main()
{
    load_frame();
#ifdef HOOKS
    begin_functions();
#endif
    if (SPEC_SECONDARY != 0u && invocation_slot() == 0u)
        generations[chunk.generation + 1u].firsts = firsts_behind();
    bool alive[SPEC_PACKET_RAYS];
    EACH_RAY {
        take_ray(r);
        alive[r] = packet_alive[r];
    }
    traverse_packets(TRAVERSE_CLOSEST, 0.0, frame.root, frame.root8, frame.eye);
    bool met[SPEC_PACKET_RAYS], waits[SPEC_PACKET_RAYS];
    uint class_of[SPEC_PACKET_RAYS], status = 0u;
    EACH_RAY {
        waits[r] = alive[r] && must_wait(packet_hits[r].status);
        met[r] = leave_ray(r, alive[r]);
        class_of[r] = class_of_hit(packet_hits[r]);
        status |= alive[r] && !waits[r] ? packet_hits[r].status : 0u;
    }
    list_hits(met, class_of, ray_id);
    if (has_bounds_alone())
        list_deferred_rays(waits, ray_id);
    report_status(status);
#ifdef HOOKS
    tally_traced(hook_traced);
    report_hooks();
#endif
}

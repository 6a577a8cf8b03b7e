// One ray of each pixel's ray tree (Whitted 1980): a camera ray, or the top of the pixel's ray
// stack. Local light with shadows goes to the pixel, the rays it calls for go on the stack. Pixels
// with rays left are listed for the next dispatch, so that no dispatch runs long.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#include "../bind/camera.glsl"
#include "../bind/crossing.glsl"
#include "../bind/lighting.glsl"

layout(local_size_x_id = 0) in;

// Whether a child of this weight is traced; what is cut is counted, with the pixel's average weight.
bool traced(vec3 weight, bool deep, inout gpu_counts count, inout uint status)
{
    if (must_wait(status))
        return false;
    float largest = largest_of(weight);
    if (any(isnan(weight))) // which is not traced, and so not seen in the sum
        status |= STATUS_NON_FINITE;
    bool small = !(largest >= frame.bailout);
    float share = largest > 0.0 ? largest * chunk.sample_weight : 0.0;
    count.cut_depth += uint(deep && largest > 0.0);
    count.cut_depth_weight += deep ? share : 0.0;
    count.cut_bailout += uint(!deep && small && largest > 0.0);
    count.cut_bailout_weight += !deep && small ? share : 0.0;
    if (SPEC_PROBE != 0u && (deep || small) && largest > 0.0)
        probe_cut(weight, deep);
    return !deep && !small;
}

// What goes on behind the surface.
void push_beyond(uint slot, Crossing c, vec3 dir, vec3 weight, uint steps, uvec4 media, uint kind,
                 inout gpu_counts count, inout uint status)
{
    if (SPEC_SECONDARY != 0u)
        push_ray(slot, count.stack, offset_origin(c.p, c.error, -c.ng), dir, weight, steps, media,
                 kind, c.instance, c.primitive, status);
}

// The rays that the surface calls for.
void push_children(uint slot, Ray ray, Surface s, Optics o, Crossing c, Hit hit,
                   inout gpu_counts count, inout uint status)
{
    bool deep = SPEC_SECONDARY == 0u || ray_bounces(ray.steps) >= frame.depth;
    uint steps = ray.steps + STEPS_OF_BOUNCE;
    float solid = 1.0 - o.straight;
    if (SPEC_REFRACTION != 0u) {
        vec3 weight = ray.weight * o.refracted * solid;
        vec3 dir = ray.dir;
        bool passes = o.thin || refract_dir(ray.dir, s.ns, o.eta, dir);
        // A shading normal may bend the ray back to its own side: then straight on.
        if (dot(dir, s.ng) >= 0.0 || dot(dir, c.ng) >= 0.0)
            dir = ray.dir;
        if (SPEC_PROBE != 0u)
            probe_next(RAY_REFRACTED, dir);
        if (passes && traced(weight, deep, count, status)) {
            push_beyond(slot, c, dir, weight, steps, o.thin ? ray.media : c.after, RAY_REFRACTED,
                        count, status);
            count.refracted++;
        }
    }
    if (SPEC_CUTOUTS != 0u || SPEC_CATCHERS != 0u) {
        vec3 weight = ray.weight * o.straight;
        if (SPEC_PROBE != 0u)
            probe_next(ray.kind | PROBE_STRAIGHT, ray.dir);
        if (traced(weight, deep, count, status))
            push_beyond(slot, c, ray.dir, weight, steps, ray.media, ray.kind, count, status);
    }
    if (SPEC_REFLECTION != 0u) {
        vec3 weight = ray.weight * o.reflected * solid;
        vec3 dir = reflect(ray.dir, s.ns);
        if (dot(dir, s.ng) <= 0.0)
            dir = reflect(ray.dir, s.ng);
        if (SPEC_PROBE != 0u)
            probe_next(RAY_REFLECTED, dir);
        if (traced(weight, deep, count, status)) {
            if (SPEC_SECONDARY != 0u)
                push_ray(slot, count.stack, offset_origin(s.p, s.error, s.ng), normalize(dir),
                         weight, steps, c.before, RAY_REFLECTED, hit.instance, hit.primitive,
                         status);
            count.reflected++;
        }
    }
}

// Straight on, where both sides of a surface are the same medium. Counted as refracted.
void push_through(uint slot, Ray ray, Crossing c, inout gpu_counts count, inout uint status)
{
    uint steps = ray.steps + 1u;
    bool deep = SPEC_SECONDARY == 0u || ray_bounces(steps) > frame.depth;
    if (SPEC_PROBE != 0u)
        probe_next(RAY_REFRACTED | PROBE_THROUGH, ray.dir);
    if (traced(ray.weight, deep, count, status)) {
        push_beyond(slot, c, ray.dir, ray.weight, steps, c.after, RAY_REFRACTED, count, status);
        count.refracted++;
    }
}

vec3 shade_hit(uint slot, Ray ray, Hit hit, inout gpu_counts count, inout uint status)
{
    Surface s = fetch_surface(hit);
    gpu_material m = fetch_material(s.material);
    bool inside = face_ray(s, ray.dir);
    Crossing c = cross_surface(slot, ray, hit, s, m, inside, status);
    if (SPEC_MEDIA != 0u && !c.seen) {
        push_through(slot, ray, c, count, status);
        return vec3(0.0);
    }
    Optics o = surface_optics(s, m, ray.dir, c.eta);
    if (dot(s.ns, ray.dir) > 0.0)
        s.ns = s.ng;
    bool catcher = SPEC_CATCHERS != 0u && (m.flags & MATERIAL_CATCHER) != 0u;
    if (catcher)
        make_catcher(o);
    vec3 open = vec3(0.0);
    vec3 light = o.unlit ? o.diffuse + o.emission
                         : local_light(slot, s, o, -ray.dir, hit, c.before, open, count.shadow,
                                       status);
    vec3 radiance = light * ray.weight * (1.0 - o.straight);
    if (catcher)
        ray.weight *= caught_share(light, open);
    push_children(slot, ray, s, o, c, hit, count, status);
    return radiance;
}

void list_for_next(uint slot)
{
    uint at = atomicAdd(work_out.count, 1u);
    slots_out[at] = slot;
    atomicMax(work_out.groups_x, at / SPEC_GROUP_SIZE + 1u);
}

void main()
{
    bool stacked = SPEC_SECONDARY != 0u && chunk.stacked != 0u;
    uint slot = own_slot();
    bool listed = SPEC_LISTED != 0u && chunk.listed != 0u;
    bool waited = SPEC_NUMERICS == NUMERICS_EXACT && SPEC_LOOKS != 0u && chunk.waiting != 0u;
    if (slot >= (waited    ? waiting.count
                 : stacked ? work_in.count
                 : listed  ? chunk.listed
                           : chunk.block_count * BLOCK_PIXELS))
        return;
    if (waited)
        slot = waiting_items[slot];
    else if (stacked || listed)
        slot = slots_in[slot];
    uvec2 at = slot_pixel(slot);
    if (at.x >= frame.width || at.y >= min(frame.height, chunk.band_y + chunk.band_rows))
        return;
    if (SPEC_PROBE != 0u && !is_probed(at))
        return;
    uint pixel = (at.y - chunk.band_y) * frame.width + at.x;

    gpu_counts count = NO_COUNTS;
    if (stacked || chunk.sample_index != 0u)
        count = counts[pixel];
    Ray ray = camera_ray(at);
    if (stacked) {
        count.stack--;
        ray = stacked_ray(slot * frame.stack_size + count.stack);
    } else {
        count.stack = 0u;
        clear_costs(slot);
    }
    Hit hit = traverse(TRAVERSE_CLOSEST, ray.origin, ray.dir, 0.0, FLOAT_LARGEST, frame.root,
                       ray.skip_instance, ray.skip_primitive);
    add_cost(slot, ray.kind);
    uint status = hit.status;
    bool met = hit.primitive != HIT_NONE;
    ray.weight *= medium_transmittance(ray.media, hit.t); // the largest float for a miss
    if (SPEC_PROBE != 0u)
        probe_begin(stacked, ray.origin, ray.dir, ray.weight, ray.media, hit);
    vec3 radiance = environment_radiance(ray.dir) * ray.weight;
    if (met)
        radiance = shade_hit(slot, ray, hit, count, status);
    if (SPEC_PROBE != 0u)
        probe_end(radiance);
    // Nothing is written yet but above the top of its ray stack.
    if (SPEC_LOOKS == 0u && must_wait(status)) {
        list_waiting(slot);
        return;
    }

    vec4 sum = vec4(radiance * chunk.sample_weight, 1.0);
    if (stacked || chunk.sample_index != 0u)
        sum.rgb += pixels[pixel].rgb;
    if (any(isnan(sum.rgb)) || any(isinf(sum.rgb)))
        status |= STATUS_NON_FINITE;
    pixels[pixel] = sum;
    counts[pixel] = count;
    if (!stacked && !listed && chunk.sample_index == 0u)
        ids[pixel] = uvec2(hit.instance, hit.primitive);
    if (SPEC_SECONDARY != 0u && count.stack != 0u)
        list_for_next(slot);
    report_status(status);
}

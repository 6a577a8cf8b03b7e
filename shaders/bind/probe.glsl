// The ray tree of one pixel's first sample, with a record for each ray. The record of a queued ray
// has the number of its id; those of shadow rays and of cut rays follow behind. Only for kernels
// with SPEC_PROBE.
#ifndef BIND_PROBE_GLSL
#define BIND_PROBE_GLSL

#include "queues.glsl"
#include "media.glsl"
#include "surface.glsl"

layout(set = 0, binding = BIND_PROBE, std430) buffer ProbeBuffer
{
    gpu_probe probe;
    gpu_probe_ray probe_rays[]; // 2 * PROBE_RAYS_MAX
};

bool is_recorded(uint id)
{
    return SPEC_PROBE != 0u && chunk.sample_index == 0u && id < PROBE_RAYS_MAX;
}

gpu_probe_ray make_probe_ray(uint kind, uint end, uint parent, vec3 origin, vec3 dir, float t_max,
                             vec3 weight, uvec2 skip, uint light_sample)
{
    gpu_probe_ray ray;
    ray.origin = origin;
    ray.kind = kind;
    ray.dir = dir;
    ray.end = end;
    ray.weight = weight;
    ray.parent = parent;
    ray.added = vec3(0.0);
    ray.t_max = t_max;
    ray.point = vec3(0.0);
    ray.t = uintBitsToFloat(0x7f800000u);
    ray.normal = vec3(0.0);
    ray.material = HIT_NONE;
    ray.u = 0.0;
    ray.v = 0.0;
    ray.primitive = HIT_NONE;
    ray.instance = HIT_NONE;
    ray.skip_primitive = skip.y;
    ray.skip_instance = skip.x;
    ray.medium = 0u;
    ray.light_sample = light_sample;
    return ray;
}

// `from` with the hit of its ray filled in.
gpu_probe_ray with_hit(gpu_probe_ray from, Hit hit)
{
    if (hit.primitive == HIT_NONE)
        return from;
    if (SPEC_NUMERICS == NUMERICS_EXACT)
        finish_hit(from.origin, from.dir, hit);
    met_origin = from.origin;
    met_dir = from.dir;
    Surface s = fetch_surface(hit);
    bool inside = dot(from.dir, s.ng) > 0.0;
    vec3 side = inside ? -s.ng : s.ng;
    from.point = s.p;
    from.t = hit.t;
    from.normal = dot(s.ns, side) < 0.0 ? -s.ns : s.ns;
    from.material = s.material;
    from.u = hit.u;
    from.v = hit.v;
    from.primitive = hit.primitive;
    from.instance = hit.instance;
    from.kind |= inside ? PROBE_INSIDE : 0u;
    return from;
}

// Records that ray `id` has been traced. `weight`: its weight where it starts; `after`: what is
// left of it at the hit; `sky`: the light that it adds where it hits nothing.
void probe_traced(uint id, vec3 origin, vec3 dir, uvec2 skip, vec3 weight, vec3 after, vec3 sky,
                  uvec4 media, Hit hit)
{
    atomicAdd(probe.rays, uint(chunk.sample_index == 0u));
    if (!is_recorded(id))
        return;
    uint kind = is_primary() ? RAY_PRIMARY : probe_rays[id].kind;
    uint parent = is_primary() ? PROBE_RAYS_MAX : probe_rays[id].parent;
    bool lost = max(after.r, max(after.g, after.b)) < frame.bailout &&
                max(weight.r, max(weight.g, weight.b)) >= frame.bailout;
    uint end = hit.primitive != HIT_NONE ? PROBE_HIT : lost ? PROBE_ABSORBED : PROBE_MISSED;
    gpu_probe_ray ray = with_hit(
        make_probe_ray(kind, end, parent, origin, dir, FLOAT_LARGEST, weight, skip, id), hit);
    ray.medium = SPEC_MEDIA != 0u ? media_top(media) : 0u;
    ray.added = hit.primitive != HIT_NONE ? after : sky; // a hit: its weight, for now
    probe_rays[id] = ray;
}

// Records that ray `id` called for ray `sent`.
void probe_sent(uint id, uint sent, uint kind)
{
    if (!is_recorded(sent))
        return;
    probe_rays[sent].kind = kind;
    probe_rays[sent].parent = id;
}

// Records a ray that has no id in the queues: a shadow ray, or one that is cut and not traced.
void probe_other(gpu_probe_ray ray)
{
    if (!is_recorded(0u))
        return;
    uint at = atomicAdd(probe.others, 1u);
    if (at < PROBE_RAYS_MAX && ray.parent < PROBE_RAYS_MAX)
        probe_rays[PROBE_RAYS_MAX + at] = ray;
}

void probe_cut_ray(uint id, uint kind, uint end, vec3 dir, vec3 weight)
{
    probe_other(make_probe_ray(kind, end, id, vec3(0.0), normalize_or(dir, vec3(0.0)), 0.0, weight,
                               uvec2(HIT_NONE), HIT_NONE));
}

void probe_shadow_ray(uint id, uint light_sample, vec3 origin, vec3 dir, float distance, uvec2 skip,
                      Hit blocker, vec3 share)
{
    uint end = blocker.primitive != HIT_NONE ? PROBE_BLOCKED : PROBE_REACHED;
    vec3 weight = is_recorded(id) ? probe_rays[id].added : vec3(0.0); // of its surface's light
    gpu_probe_ray ray = with_hit(
        make_probe_ray(RAY_SHADOW, end, id, origin, dir, distance, weight, skip, light_sample), blocker);
    ray.added = share;
    probe_other(ray);
}

// Records the light that ray `id` adds by itself; for a shadow catcher the share of what lies
// behind it that it shows.
void probe_added(uint id, vec3 added, bool catcher)
{
    if (!is_recorded(id))
        return;
    probe_rays[id].added = added;
    probe_rays[id].kind |= catcher ? PROBE_CATCHER : 0u;
}

#endif

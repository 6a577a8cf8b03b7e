// The ray tree of one pixel's first sample, as it is traced: a record for each ray, in the order in
// which rays are called for. With SPEC_PROBE, and only then in a kernel.
#ifndef BIND_PROBE_GLSL
#define BIND_PROBE_GLSL

#include "media.glsl"
#include "picture.glsl"
#include "surface.glsl"

layout(set = 0, binding = BIND_PROBE, std430) buffer ProbeBuffer
{
    gpu_probe probe;
    gpu_probe_ray probe_rays[]; // probe.capacity
};

const uint PROBE_NONE = PROBE_RAYS_MOST;

uint probe_own;    // record of the ray in hand
uint probe_shadow; // of the last shadow ray
vec3 probe_weight; // of the ray in hand, where it has come to
uint probe_kind;   // of the next ray that it may leave
vec3 probe_dir;

bool is_probed(uvec2 pixel)
{
    return pixel == uvec2(probe.pixel_x, probe.pixel_y);
}

// Its number; PROBE_NONE where there is no more room, and for samples after the first.
uint probe_record(uint kind, uint end, uint parent, vec3 origin, vec3 dir, float t_max, vec3 weight,
                  uint skip_instance, uint skip_primitive)
{
    if (chunk.sample_index != 0u)
        return PROBE_NONE;
    uint at = probe.count;
    probe.count = at + 1u;
    if (at >= probe.capacity)
        return PROBE_NONE;
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
    ray.skip_primitive = skip_primitive;
    ray.skip_instance = skip_instance;
    ray.medium = 0u;
    ray.turn = 0u;
    probe_rays[at] = ray;
    return at;
}

// What the ray of a record met.
void probe_meet(uint at, vec3 origin, vec3 dir, Hit hit)
{
    if (at == PROBE_NONE || hit.primitive == HIT_NONE)
        return;
    if (SPEC_NUMERICS == NUMERICS_EXACT)
        finish_hit(origin, dir, hit);
    Surface s = fetch_surface(hit);
    bool inside = dot(dir, s.ng) > 0.0;
    vec3 side = inside ? -s.ng : s.ng;
    probe_rays[at].point = s.p;
    probe_rays[at].t = hit.t;
    probe_rays[at].normal = dot(s.ns, side) < 0.0 ? -s.ns : s.ns;
    probe_rays[at].material = s.material;
    probe_rays[at].u = hit.u;
    probe_rays[at].v = hit.v;
    probe_rays[at].primitive = hit.primitive;
    probe_rays[at].instance = hit.instance;
    probe_rays[at].kind |= inside ? PROBE_INSIDE : 0u;
}

// The ray in hand has been traced. `weight`: what is left of it where it has come to.
void probe_begin(bool stacked, vec3 origin, vec3 dir, vec3 weight, uvec4 media, Hit hit)
{
    if (!stacked)
        probe_own = probe_record(RAY_PRIMARY, PROBE_WAITS, PROBE_NONE, origin, dir, FLOAT_LARGEST,
                                 vec3(1.0), HIT_NONE, HIT_NONE);
    probe_weight = weight;
    if (probe_own == PROBE_NONE)
        return;
    vec3 sent = probe_rays[probe_own].weight;
    float before = max(sent.r, max(sent.g, sent.b));
    float after = max(weight.r, max(weight.g, weight.b));
    bool lost = after < frame.bailout && before >= frame.bailout;
    probe_rays[probe_own].end = hit.primitive != HIT_NONE ? PROBE_HIT
                                : lost                    ? PROBE_ABSORBED
                                                          : PROBE_MISSED;
    probe_rays[probe_own].medium = SPEC_MEDIA != 0u ? media_top(media) : 0u;
    probe_meet(probe_own, origin, dir, hit);
}

void probe_end(vec3 radiance)
{
    if (probe_own != PROBE_NONE)
        probe_rays[probe_own].added = radiance;
}

// Before a ray is weighed that the ray in hand may leave.
void probe_next(uint kind, vec3 dir)
{
    probe_kind = kind;
    probe_dir = dir;
}

void probe_cut(vec3 weight, bool deep)
{
    probe_record(probe_kind, deep ? PROBE_DEPTH : PROBE_BAILOUT, probe_own, vec3(0.0),
                 normalize_or(probe_dir, vec3(0.0)), 0.0, weight, HIT_NONE, HIT_NONE);
}

// A ray goes on the stack: bits for its `state`.
uint probe_push(vec3 origin, vec3 dir, vec3 weight, uint skip_instance, uint skip_primitive)
{
    return probe_record(probe_kind, PROBE_WAITS, probe_own, origin, dir, FLOAT_LARGEST, weight,
                        skip_instance, skip_primitive) << STATE_PROBE_SHIFT;
}

// Takes them from there again, and leaves the ray's steps.
uint probe_pop(uint state)
{
    probe_own = (state >> STATE_PROBE_SHIFT) & PROBE_RAYS_MOST;
    return state & ((1u << STATE_PROBE_SHIFT) - 1u);
}

void probe_blocker(uint turn, vec3 origin, vec3 dir, float distance, uint skip_instance,
                   uint skip_primitive, Hit blocker)
{
    bool blocked = blocker.primitive != HIT_NONE;
    probe_shadow = probe_record(RAY_SHADOW, blocked ? PROBE_BLOCKED : PROBE_REACHED, probe_own,
                                origin, dir, distance, probe_weight, skip_instance, skip_primitive);
    if (probe_shadow != PROBE_NONE)
        probe_rays[probe_shadow].turn = turn;
    probe_meet(probe_shadow, origin, dir, blocker);
}

void probe_share(vec3 share)
{
    if (probe_shadow != PROBE_NONE)
        probe_rays[probe_shadow].added = share;
}

#endif

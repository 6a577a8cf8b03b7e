// The rays of a pixel's ray tree that wait to be traced.
#ifndef BIND_RAY_STACK_GLSL
#define BIND_RAY_STACK_GLSL

#include "picture.glsl"
#include "probe.glsl"

layout(set = 0, binding = BIND_RAY_STACKS, std430) buffer RayStackBuffer
{
    gpu_stacked_ray ray_stacks[]; // frame.stack_size per slot of the chunk
};

layout(set = 0, binding = BIND_RAY_MEDIA, std430) buffer RayMediaBuffer
{
    uvec4 ray_media[]; // struct gpu_media beside each of ray_stacks; with SPEC_MEDIA
};

const gpu_counts NO_COUNTS = gpu_counts(0u, 0u, 0u, 0u, 0u, 0u, 0.0, 0.0);

struct Ray {
    vec3 origin, dir, weight;
    uvec4 media; // struct gpu_media
    uint steps;  // ray_bounces() and, below them, surfaces that were passed unseen
    uint skip_primitive, skip_instance;
    uint kind; // RAY_*; with SPEC_COUNT or SPEC_PROBE
};

// Where a ray passes more surfaces unseen than the steps of one bounce, it counts as one: so every
// ray tree ends.
const uint STEPS_OF_BOUNCE = 1u << STATE_BOUNCES_SHIFT;

uint ray_bounces(uint steps)
{
    return steps >> STATE_BOUNCES_SHIFT;
}

Ray stacked_ray(uint index)
{
    gpu_stacked_ray stacked = ray_stacks[index];
    Ray ray;
    ray.origin = stacked.origin;
    ray.dir = stacked.dir;
    ray.weight = stacked.weight;
    ray.media = SPEC_MEDIA != 0u ? ray_media[index] : uvec4(0u);
    ray.steps = stacked.state & ((1u << STATE_KIND_SHIFT) - 1u);
    ray.kind = stacked.state >> STATE_KIND_SHIFT;
    if (SPEC_PROBE != 0u)
        ray.steps = probe_pop(ray.steps);
    ray.skip_primitive = stacked.skip_primitive;
    ray.skip_instance = stacked.skip_instance;
    return ray;
}

void push_ray(uint slot, inout uint top, vec3 origin, vec3 dir, vec3 weight, uint steps,
              uvec4 media, uint kind, uint skip_instance, uint skip_primitive,
              inout uint status)
{
    if (top >= frame.stack_size) {
        status |= STATUS_RAY_STACK_OVERFLOW;
        return;
    }
    gpu_stacked_ray stacked;
    stacked.origin = origin;
    stacked.dir = dir;
    stacked.weight = weight;
    stacked.state = steps;
    if (SPEC_COUNT != 0u || SPEC_PROBE != 0u)
        stacked.state |= kind << STATE_KIND_SHIFT;
    if (SPEC_PROBE != 0u)
        stacked.state |= probe_push(origin, dir, weight, skip_instance, skip_primitive);
    stacked.skip_primitive = skip_primitive;
    stacked.skip_instance = skip_instance;
    ray_stacks[slot * frame.stack_size + top] = stacked;
    if (SPEC_MEDIA != 0u)
        ray_media[slot * frame.stack_size + top] = media;
    top++;
}

#endif

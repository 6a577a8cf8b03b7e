// A ray of a picture between its stages.
#ifndef BIND_RAY_GLSL
#define BIND_RAY_GLSL

#include "picture.glsl"

struct Ray {
    vec3 origin, dir, weight;
    uvec4 media; // struct gpu_media
    uint steps;  // ray_bounces() and, below them, surfaces that were passed unseen
    uint skip_primitive, skip_instance;
    uint skip_record; // of that primitive, where it is to be queued
    uint kind; // RAY_*; with SPEC_COUNT or SPEC_PROBE
    float way; // from the eye to its origin along the rays before it; with SPEC_MINIFICATION
};

// Where a ray passes more surfaces unseen than the steps of one bounce, it counts as one: so every
// ray tree ends.
const uint STEPS_OF_BOUNCE = 1u << STATE_BOUNCES_SHIFT;

uint ray_bounces(uint steps)
{
    return steps >> STATE_BOUNCES_SHIFT;
}

#endif

// A ray of a picture between its stages.
#ifndef BIND_RAY_GLSL
#define BIND_RAY_GLSL

#include "picture.glsl"

struct Ray {
    vec3 origin, dir, weight;
    uvec4 media; // see MEDIA_MAX
    uint steps;  // ray_bounces(), and in the low bits the number of surfaces passed unseen
    uint skip_primitive, skip_instance;
    uint skip_record; // record of that primitive, see RECORD_SKIPS_ALL; set where the ray is to be
                      // queued
    uint kind; // RAY_*; with SPEC_COUNT or SPEC_PROBE
    float way; // distance from the eye to its origin along the rays before it; with
               // SPEC_MINIFICATION
};

// Steps that count as one bounce. So a ray that passes that many surfaces unseen has made a bounce,
// and every ray tree ends.
const uint STEPS_OF_BOUNCE = 1u << STATE_BOUNCES_SHIFT;

uint ray_bounces(uint steps)
{
    return steps >> STATE_BOUNCES_SHIFT;
}

#endif

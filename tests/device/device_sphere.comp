#version 450
#extension GL_GOOGLE_include_directive : require
/* lib/exact_sphere.glsl and lib/ff_sphere.glsl on every input. */
#include "../../shaders/lib/ff_sphere.glsl"
layout(local_size_x = 64) in;
struct Case {
    vec3 origin;
    float radius;
    vec3 dir;
    float t_min;
    vec3 center;
    uint only_far;
};
struct Answer {
    float near_lo, near_hi, far_lo, far_hi;
    float key, pair_key;
    uint said;     // of the integers: met 1, at_exit 2, inward 4; of pairs 8, 16, 32; pairs are sure: 64
    uint filtered; // outside 1, inside 2, inward_known 4; integers came to their end: 8
};
layout(set = 0, binding = 0, std430) readonly buffer Cases
{
    Case cases[];
};
layout(set = 0, binding = 1, std430) writeonly buffer Answers
{
    Answer answers[];
};

uint bits_of(bool a, bool b, bool c)
{
    return uint(a) | uint(b) << 1 | uint(c) << 2;
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= cases.length())
        return;
    Case c = cases[i];
    SphereBounds bounds = bound_sphere(make_ray_setup(c.origin, c.dir), c.center, c.radius);
    bool finished;
    SphereCandidate exact = exact_meet_sphere(c.origin, c.dir, c.center, c.radius, c.only_far != 0u,
                                            c.t_min, finished);
    SphereCandidate pairs;
    bool sure = ff_meet_sphere(c.origin, c.dir, c.center, c.radius, c.only_far != 0u, c.t_min,
                                 pairs);
    Answer a;
    a.near_lo = bounds.near_lo;
    a.near_hi = bounds.near_hi;
    a.far_lo = bounds.far_lo;
    a.far_hi = bounds.far_hi;
    a.key = exact.key;
    a.pair_key = sure ? pairs.key : 0.0;
    a.said = bits_of(exact.met, exact.at_exit, exact.inward) |
             (sure ? bits_of(pairs.met, pairs.at_exit, pairs.inward) << 3 | 64u : 0u);
    a.filtered = bits_of(bounds.outside, bounds.inside, bounds.inward_known) |
                 (finished ? 8u : 0u);
    answers[i] = a;
}

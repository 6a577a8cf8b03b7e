#version 450
#extension GL_GOOGLE_include_directive : require
/* exact_filter of lib/exact.glsl on every input. */
#include "../../shaders/lib/exact.glsl"
layout(local_size_x = 64) in;
struct Case {
    vec3 shear;
    uint dominant; // 0: x, 1: y, 2: z
    vec3 a;
    float pad_a;
    vec3 b;
    float pad_b;
    vec3 c;
    float pad_c;
};
struct Answer {
    float t, u, v, lo, hi;
    uint said; // 1: outside, 2: inside
};
layout(set = 0, binding = 0, std430) readonly buffer Cases
{
    Case cases[];
};
layout(set = 0, binding = 1, std430) writeonly buffer Answers
{
    Answer answers[];
};

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= cases.length())
        return;
    Case c = cases[i];
    RaySetup ray;
    ray.shear = c.shear;
    ray.dominant = bvec2(c.dominant == 0u, c.dominant == 1u);
    ExactBounds bounds = exact_filter(ray, c.a, c.b, c.c);
    answers[i] = Answer(bounds.t, bounds.u, bounds.v, bounds.lo, bounds.hi,
                        (bounds.outside ? 1u : 0u) | (bounds.inside ? 2u : 0u));
}

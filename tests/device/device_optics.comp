#version 450
#extension GL_GOOGLE_include_directive : require
/* The functions of lib/optics.glsl, each on every input. */
#include "../../shaders/lib/optics.glsl"
layout(local_size_x = 64) in;
struct Case {
    vec3 dir;
    float eta;
    vec3 n;
    float cos_in;
    float cos_half, cos_light, cos_view, alpha;
    float shininess, pad0, pad1, pad2;
};
struct Answer {
    vec3 refracted;
    float passes;
    float exact, schlick, blinn, ggx;
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
    Answer a;
    a.passes = refract_dir(c.dir, c.n, c.eta, a.refracted) ? 1.0 : 0.0;
    a.exact = fresnel_dielectric(c.cos_in, c.eta);
    a.schlick = schlick_dielectric(c.cos_in, c.eta);
    a.blinn = blinn_highlight(c.cos_half, c.shininess);
    a.ggx = ggx_highlight(c.cos_half, c.cos_light, c.cos_view, c.alpha);
    answers[i] = a;
}

// The module of a user's functions, from which host/shader/link.c takes them into the stages'
// kernels. It never runs.
#version 460
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_GOOGLE_include_directive : require
#include "../hook/interface.glsl"

layout(local_size_x = 1) in;

#include "../hook/user.glsl"

// Calls the file's functions, so that the compiler checks them against their declarations.
void whit_call_all()
{
    Surface s;
    Optics o;
    Rays rays;
    vec3 sum = vec3(0.0);
    camera(vec2(0.0), sum, sum);
    surface(s);
    scatter(s, o, rays);
#ifdef HAS_AOV
    sum += aov(0u, s).xyz;
#endif
#ifdef HAS_INTERSECT
    sum.x += float(intersect(sum, sum, sum.x, sum.x, sum));
    shape_box(sum, sum, sum.x);
#endif
#ifdef HAS_TESTS
    run_test(0u, 0u);
#endif
    sum += shade(s, o, sum) + miss(sum) + post(ivec2(0), sum);
}

// Without this call, which is left out of kernels, a missing function would be no error.
void main()
{
    whit_call_all();
}

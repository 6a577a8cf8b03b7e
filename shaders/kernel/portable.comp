#version 450
// Answers what a function of lib/portable.glsl gives for pairs of floats: for tests, for what
// `whit devices` finds out of a device, and as the module that host/shader/portable.c takes functions
// from.
#extension GL_GOOGLE_include_directive : require
#include "../abi/portable.h"
#include "../lib/portable.glsl"

layout(constant_id = 1) const uint FUNCTION = PORTABLE_DIVIDE;
layout(local_size_x = 64) in;

layout(set = 0, binding = 0, std430) readonly buffer Cases
{
    uvec2 cases[];
};
layout(set = 0, binding = 1, std430) writeonly buffer Answers
{
    uint answers[];
};

// One branch each, of which host/device/evaluate.c leaves the one that is asked for.
uint answer(const float x, const float y)
{
    float found = x + y;
    if (FUNCTION == PORTABLE_INT)
        return uint(portable_int(x));
    if (FUNCTION == PORTABLE_UINT)
        return portable_uint(x);
    if (FUNCTION == PORTABLE_DIVIDE)
        found = portable_divide(x, y);
    if (FUNCTION == PORTABLE_SQRT)
        found = portable_sqrt(x);
    if (FUNCTION == PORTABLE_INVERSESQRT)
        found = portable_inversesqrt(x);
    if (FUNCTION == PORTABLE_EXP2)
        found = portable_exp2(x);
    if (FUNCTION == PORTABLE_EXP)
        found = portable_exp(x);
    if (FUNCTION == PORTABLE_LOG2)
        found = portable_log2(x);
    if (FUNCTION == PORTABLE_LOG)
        found = portable_log(x);
    if (FUNCTION == PORTABLE_POW)
        found = portable_pow(x, y);
    if (FUNCTION == PORTABLE_SIN)
        found = portable_sin(x);
    if (FUNCTION == PORTABLE_COS)
        found = portable_cos(x);
    if (FUNCTION == PORTABLE_TAN)
        found = portable_tan(x);
    if (FUNCTION == PORTABLE_ASIN)
        found = portable_asin(x);
    if (FUNCTION == PORTABLE_ACOS)
        found = portable_acos(x);
    if (FUNCTION == PORTABLE_ATAN)
        found = portable_atan(x);
    if (FUNCTION == PORTABLE_ATAN2)
        found = portable_atan(x, y);
    if (FUNCTION == PORTABLE_MIN)
        found = portable_min(x, y);
    if (FUNCTION == PORTABLE_MAX)
        found = portable_max(x, y);
    return floatBitsToUint(found);
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < uint(answers.length()))
        answers[i] = answer(uintBitsToFloat(cases[i].x), uintBitsToFloat(cases[i].y));
}

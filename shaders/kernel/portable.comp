#version 450
// Computes a function of lib/portable.glsl for pairs of floats: for tests, for what `whit devices`
// finds out about a device, and as the module that host/shader/portable.c takes functions from.
#extension GL_GOOGLE_include_directive : require
#include "../abi/portable.h"
#include "../lib/portable.glsl"

layout(constant_id = 1) const uint FUNCTION = PORTABLE_DIVIDE;
layout(local_size_x = 64) in;

layout(set = 0, binding = 0, std430) readonly buffer Cases
{
    uvec2 cases[];
};
layout(set = 0, binding = 1, std430) buffer Answers
{
    uint answers[];
};

// One branch for each function; host/device/evaluate.c leaves the one that FUNCTION chooses.
uint answer(const float x, const float y)
{
    float found = x + y; // PORTABLE_SUM
    if (FUNCTION == PORTABLE_PRODUCT)
        found = x * y;
    if (FUNCTION == PORTABLE_RELATIONS)
        return uint(portable_less(x, y)) | uint(portable_at_most(x, y)) << 1 | uint(portable_equal(x, y)) << 2 |
               uint(portable_unequal(x, y)) << 3 | uint(portable_more(x, y)) << 4 |
               uint(portable_at_least(x, y)) << 5 | uint(portable_step(x, y) != 0.0) << 6;
    if (FUNCTION == PORTABLE_ABS)
        found = portable_abs(x);
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

bool is_other(const float x, const float y)
{
    return floatBitsToUint(x) != floatBitsToUint(y) && !(portable_isnan(x) && portable_isnan(y));
}

// A hash of n: lowbias32 (Wellons 2018).
uint scramble(uint n)
{
    n = (n ^ n >> 16) * 0x7feb352du;
    n = (n ^ n >> 15) * 0x846ca68bu;
    return n ^ n >> 16;
}

// Whether the device's own result for case n has other bits than that of lib/portable.glsl. The
// cases: square roots of all floats from 1 to 4, which stand for all others by even powers of two;
// 1 / x of all from 1 to 4; and quotients of any two floats, denormals, infinities and NaN
// included.
bool compare(const uint n)
{
    float x = uintBitsToFloat(0x3f800000u + n % COMPARED_ROOTS);
    if (n < COMPARED_ROOTS)
        return is_other(sqrt(x), rooted(x));
    if (n < COMPARED_ROOTS + COMPARED_INVERSES)
        return is_other(1.0 / x, divided(1.0, x));
    x = uintBitsToFloat(scramble(n));
    float y = uintBitsToFloat(scramble(n + 0x9e3779b9u));
    return is_other(x / y, divided(x, y));
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (FUNCTION == PORTABLE_COMPARED) { // cases[0].x: the first number of this dispatch
        uint n = cases[0].x + i;
        if (n < COMPARED_ALL && compare(n))
            atomicAdd(answers[0], 1u);
    } else if (i < uint(answers.length()))
        answers[i] = answer(uintBitsToFloat(cases[i].x), uintBitsToFloat(cases[i].y));
}

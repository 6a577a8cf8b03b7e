#version 450
#extension GL_GOOGLE_include_directive : require
/* Points of lib/sequence.glsl. */
#include "../../shaders/lib/sequence.glsl"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Cases
{
    uint indices[];
};
layout(set = 0, binding = 1, std430) writeonly buffer Answers
{
    uvec2 points[];
};

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < indices.length())
        points[i] = sequence_point(indices[i]);
}

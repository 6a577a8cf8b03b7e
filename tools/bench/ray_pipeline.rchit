#version 460
#extension GL_EXT_ray_tracing : require

layout(location = 0) rayPayloadInEXT uvec4 found;
hitAttributeEXT vec2 uv;

void main()
{
    found = uvec4(floatBitsToUint(gl_HitTEXT), floatBitsToUint(uv), uint(gl_PrimitiveID));
}

#version 460
#extension GL_EXT_ray_tracing : require

layout(location = 0) rayPayloadInEXT uvec4 found;

void main()
{
    found = uvec4(0x7f800000u, 0u, 0u, 0xffffffffu); // infinity; no primitive
}

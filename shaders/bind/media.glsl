// What a ray travels through.
#ifndef BIND_MEDIA_GLSL
#define BIND_MEDIA_GLSL

#include "shading.glsl"

// Beer's law along `t` world units of the medium that a ray is in.
vec3 medium_transmittance(uvec4 media, float t)
{
    uint medium = media.x & 0xffffu;
    if (SPEC_ABSORPTION == 0u || SPEC_MEDIA == 0u || medium == 0u)
        return vec3(1.0);
    vec3 depth = fetch_material(medium - 1u).absorption * t;
    return exp(-clamp(depth, vec3(0.0), vec3(100.0)));
}

#endif

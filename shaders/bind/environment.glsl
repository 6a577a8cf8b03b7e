// Light of the environment: a map, or the colours of a sky.
#ifndef BIND_ENVIRONMENT_GLSL
#define BIND_ENVIRONMENT_GLSL

#include "../lib/octahedron.glsl"
#include "picture.glsl"

layout(set = 0, binding = BIND_ENVIRONMENT, std430) readonly buffer EnvironmentBuffer
{
    vec4 environment_texels[];
};

vec3 fetch_environment(ivec2 at, int size)
{
    return environment_texels[clamp(at.y, 0, size - 1) * size + clamp(at.x, 0, size - 1)].rgb;
}

// The radiance of the environment along unit `dir`, for rays that meet nothing.
vec3 environment(vec3 dir)
{
    if (SPEC_ENVIRONMENT_MAP != 0u && frame.environment_size != 0u) {
        int size = int(frame.environment_size);
        vec2 at = octahedron_from_dir(dir) * float(size) - 0.5;
        vec2 corner = floor(at);
        vec2 part = at - corner;
        ivec2 c = ivec2(corner);
        vec3 top = mix(fetch_environment(c, size), fetch_environment(c + ivec2(1, 0), size), part.x);
        vec3 bottom = mix(fetch_environment(c + ivec2(0, 1), size),
                          fetch_environment(c + ivec2(1, 1), size), part.x);
        return mix(top, bottom, part.y);
    }
    return mix(frame.horizon, dir.y >= 0.0 ? frame.zenith : frame.ground, min(abs(dir.y), 1.0));
}

#endif

// Where light comes from: environment and lights.
#ifndef BIND_LIGHT_GLSL
#define BIND_LIGHT_GLSL

#include "../lib/octahedron.glsl"
#include "shading.glsl"

layout(set = 0, binding = BIND_ENVIRONMENT, std430) readonly buffer EnvironmentBuffer
{
    vec4 environment_texels[];
};

vec3 fetch_environment(ivec2 at, int size)
{
    return environment_texels[clamp(at.y, 0, size - 1) * size + clamp(at.x, 0, size - 1)].rgb;
}

// What a ray along unit `dir` sees when it meets nothing.
vec3 environment_radiance(vec3 dir)
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

// Direction to a light (unit), its distance, and what arrives there over pi, before shadows.
// False: nothing arrives.
bool light_at(uint index, vec3 p, out vec3 to_light, out float distance, out vec3 arriving)
{
    gpu_light light = fetch_light(index);
    arriving = light.color;
    if (light.kind == LIGHT_DIRECTIONAL) {
        to_light = -light.direction;
        distance = uintBitsToFloat(0x7f7fffffu);
        return true;
    }
    vec3 way = light.position - p;
    float largest = max(abs(way.x), max(abs(way.y), abs(way.z)));
    if (!(largest > 0.0)) {
        to_light = vec3(0.0);
        distance = 0.0;
        return false;
    }
    distance = length(way / largest) * largest;
    to_light = way / distance;
    if (light.falloff != 0u)
        arriving /= distance * distance;
    float cos_away = -dot(to_light, light.direction);
    if (light.kind == LIGHT_SPOT) {
        float part = (cos_away - light.cos_outer) / max(light.cos_inner - light.cos_outer, 1e-6);
        float soft = clamp(part, 0.0, 1.0);
        arriving *= soft * soft;
    } else if (light.kind == LIGHT_AREA_SAMPLE) {
        arriving *= light.two_sided != 0u ? abs(cos_away) : max(cos_away, 0.0);
    }
    if (distance > light.range)
        return false;
    return max(arriving.r, max(arriving.g, arriving.b)) > 0.0;
}

#endif

// Light of lights.
#ifndef BIND_LIGHT_GLSL
#define BIND_LIGHT_GLSL

#include "../lib/polygon.glsl"
#include "../lib/sequence.glsl"
#include "picture.glsl"

const float LIGHT_MAX = 1e24; // bounds radiance, so that sums of light cannot overflow

// One iteration of the loop over lights: a light, or one point of a flat emitter.
struct LightSample {
    vec3 to_light; // unit
    float distance;
    vec3 arriving;  // irradiance over pi, facing the light, before shadows
    float strength; // flat emitters: arriving = color * area_share * strength
};

bool is_flat(gpu_light light)
{
    return (SPEC_LIGHTS & LIGHT_FLAT_BITS) != 0u && ((LIGHT_FLAT_BITS >> light.kind) & 1u) != 0u;
}

// The number of points of each light; only flat emitters use more than the first.
uint turns_each()
{
    return (SPEC_LIGHTS & LIGHT_FLAT_BITS) != 0u ? frame.light_samples : 1u;
}

// Point `index` on a flat emitter, from the sequence of points behind those of earlier samples; the
// same for all pixels.
vec3 emitter_point(gpu_light light, uint index)
{
    uvec2 at = sequence_point(chunk.light_index + index);
    float u = float(at.x >> 8) * (1.0 / 16777216.0);
    float v = float(at.y >> 8) * (1.0 / 16777216.0);
    if (light.kind == LIGHT_TRIANGLE) { // keeps areas (Turk 1990)
        float root = sqrt(u);
        u = root * (1.0 - v);
        v = root * v;
    }
    return light.position + light.edge_u * u + light.edge_v * v;
}

// The point of a light that sample `index` comes from; undefined for a directional light.
vec3 light_point(gpu_light light, uint index)
{
    return is_flat(light) ? emitter_point(light, index) : light.position;
}

// The form factor of an emitter that is smaller than this share of its distance is that of its
// middle, which is off by up to the square of the share. The sum of edge terms is off by roundings,
// 1e-6 divided by the share.
const float SMALL_EMITTER = 1.0 / 128.0;

// Form factor of an emitter all of which is `away`, as polygon_form_factor gives it. `c0`: its first
// corner, in units of `away`.
float small_form_factor(gpu_light light, vec3 c0, float away, vec3 n)
{
    bool triangle = light.kind == LIGHT_TRIANGLE;
    vec3 u = light.edge_u / away, v = light.edge_v / away;
    vec3 middle = c0 + (u + v) * (triangle ? 1.0 / 3.0 : 0.5);
    float square = dot(middle, middle);
    float area_seen = -dot(cross(u, v), middle) * (triangle ? 0.5 : 1.0);
    return area_seen * max(dot(n, middle), 0.0) / (POLYGON_PI * square * square);
}

// Form factor of a flat emitter at `p`, which may be off by `error`, with shading normal `n`,
// without shadows.
float emitter_form_factor(gpu_light light, vec3 p, vec3 error, vec3 n)
{
    vec3 c0 = light.position - p;
    vec3 c1 = c0 + light.edge_u, c3 = c0 + light.edge_v;
    vec3 c2 = light.kind == LIGHT_TRIANGLE ? c3 : c1 + light.edge_v;
    float height = -dot(c0, light.direction);
    // Zero in the emitter's own plane, within the rounding of the point: else it would light
    // itself.
    if (abs(height) <= dot(rounding_bound(4.0) * abs(c0) + error, abs(light.direction)))
        return 0.0;
    float factor = polygon_form_factor(n, c0, c1, c2, c3);
    vec3 reach = abs(c0), side = max(abs(light.edge_u), abs(light.edge_v));
    float away = max(reach.x, max(reach.y, reach.z));
    if (max(side.x, max(side.y, side.z)) < away * SMALL_EMITTER)
        factor = small_form_factor(light, c0 / away, away, n);
    bool front = height > 0.0;
    return front ? max(factor, 0.0) : light.two_sided != 0u ? max(-factor, 0.0) : 0.0;
}

// How far a point of an emitter may be from a hit of a surface in the same plane: more than the
// roundings of their coordinates, and more than the margin of boxes of instances, so that rays do
// not enter what they end before. `way`: the largest component of the way from `p` to the point.
float plane_rounding(vec3 p, float way)
{
    return (max(abs(p.x), max(abs(p.y), abs(p.z))) + way) * LIGHT_END_ROUNDING;
}

// Sample `index` of a light towards `p`. False: nothing arrives.
bool light_at(gpu_light light, uint index, vec3 p, out LightSample from)
{
    bool flat_emitter = is_flat(light);
    from.arriving = light.color;
    from.strength = 0.0;
    if (((SPEC_LIGHTS >> light.kind) & 1u) == 0u)
        return false;
    if ((SPEC_LIGHTS & (1u << LIGHT_DIRECTIONAL)) != 0u && light.kind == LIGHT_DIRECTIONAL) {
        from.to_light = -light.direction;
        from.distance = uintBitsToFloat(0x7f7fffffu);
        return true;
    }
    vec3 way = light_point(light, index) - p;
    float largest = max(abs(way.x), max(abs(way.y), abs(way.z)));
    if (!(largest > 0.0)) {
        from.to_light = vec3(0.0);
        from.distance = 0.0;
        return false;
    }
    from.distance = length(way / largest) * largest;
    from.to_light = way / from.distance;
    float square = max(from.distance * from.distance, 1.17549435e-38);
    if (light.falloff != 0u)
        from.arriving /= square;
    float cos_away = -dot(from.to_light, light.direction);
    float cos_emitter = light.two_sided != 0u ? abs(cos_away) : max(cos_away, 0.0);
    if ((SPEC_LIGHTS & (1u << LIGHT_SPOT)) != 0u && light.kind == LIGHT_SPOT) {
        // 1 - cosine, by the difference of two unit vectors: exact also near the middle.
        vec3 off = from.to_light + light.direction;
        float soft = clamp((light.spot_edge - 0.5 * dot(off, off)) * light.spot_slope, 0.0, 1.0);
        from.arriving *= soft * soft;
    }
    if ((SPEC_LIGHTS & (1u << LIGHT_AREA_SAMPLE)) != 0u && light.kind == LIGHT_AREA_SAMPLE)
        from.arriving *= cos_emitter;
    if (flat_emitter) {
        from.strength = min(cos_emitter / square, LIGHT_MAX);
        from.arriving = light.color * (light.area_share * from.strength);
    }
    from.arriving = min(from.arriving, vec3(LIGHT_MAX));
    float far = from.distance * light.per_range;
    from.arriving *= max(1.0 - (far * far) * (far * far), 0.0); // KHR_lights_punctual, "range"
    // Shortened: a surface in which the light lies, as a ceiling may be, casts no shadow.
    if (flat_emitter || light.kind == LIGHT_AREA_SAMPLE) {
        float off = max(light.end, plane_rounding(p, largest));
        from.distance -= min(from.distance * LIGHT_END_SHARE_MAX, off / abs(cos_away));
    } else
        from.distance -= from.distance * light.end;
    return max(from.arriving.r, max(from.arriving.g, from.arriving.b)) > 0.0;
}

#endif

// Light that shadow rays lose in filters that vary over their surface: filters with textures or
// vertex colours, and bodies that absorb. In 1/256 stops, as integers, whose sum does not depend on
// the order in which a ray hits the filters.
#ifndef BIND_FILTER_GLSL
#define BIND_FILTER_GLSL

#include "media.glsl"
#include "surface.glsl"

// Absorption along a shadow ray is counted relative to one t of the ray, filter_end, behind which it
// enters and leaves no body. A surface where the ray enters a body adds what the body would absorb
// from there to that t, a surface where it leaves subtracts it, and a ray that starts in a body
// starts with all of it (surrounding_absorption). What remains is the absorption of the path inside,
// wherever the ray's ends are. That t is the light, or, where the ray leaves the sphere around the
// scene before, a point behind the sphere: the sum of distances to a light far away would be rounded
// by more than the path inside. No sun is inside a body, so its ray may count from 0. Open meshes: a
// ray that enters and never leaves is absorbed up to filter_end, as a camera ray that stays in the
// medium is; a ray that leaves without having entered gets a sum below 0, which counts as 0.
float filter_end(vec3 origin, float t_max)
{
    float behind = distance(origin, frame.scene_center) + frame.scene_radius;
    return t_max < FLOAT_LARGEST ? min(t_max, behind) : 0.0;
}

// Depths from 2^29 on (exp(-1.4e6)) grow by 2^24 for each doubling, so that they do not overflow, and
// a surface behind another still has another depth. Sums may wrap around and back. There one
// rounding of the way changes the light by a sixth.
const float DEPTH_LINEAR = 536870912.0, DEPTH_MAX = 2305843009213693952.0; // 2^29, 2^61

ivec3 absorption_depth(vec3 absorption, float way)
{
    vec3 depth = min(absorption * (abs(way) * FILTER_DEPTH_OF_ABSORPTION), vec3(DEPTH_MAX));
    ivec3 above = max(floatBitsToInt(depth) - floatBitsToInt(DEPTH_LINEAR), ivec3(0));
    ivec3 whole = ivec3(floor(min(depth, vec3(DEPTH_LINEAR)) + 0.5)) + 2 * above;
    return way < 0.0 ? -whole : whole;
}

// The sum of the absorption of all media around a point. Where media overlap, each of them absorbs
// light of shadow rays; for rays that the eye sees only the medium with the highest priority does.
vec3 surrounding_absorption(uvec4 media)
{
    vec3 sum = vec3(0.0);
    if (SPEC_FILTER_DETAIL == 0u || SPEC_ABSORPTION == 0u || SPEC_MEDIA == 0u)
        return sum;
    uint count = media_count(media), i = 0u;
    do {
        if (i < count)
            sum += fetch_material(media_entry(media, i) - 1u).absorption;
        i++;
    } while (i < count);
    return sum;
}

// The optical depth, in 1/256 stops, of a filter that lets the share `kept` pass, rounded as in
// records of filters that do not vary; for a share of 0 nothing passes.
ivec3 filter_depth(vec3 kept)
{
    vec3 depth = FILTER_DEPTH_OF_RECORD * floor(-SHADOW_DEPTH_SCALE * log2(max(kept, vec3(1e-30))) + 0.5);
    return ivec3(mix(max(depth, vec3(0.0)), vec3(FILTER_DEPTH_OPAQUE), lessThanEqual(kept, vec3(0.0))));
}

// The optical depth of a filter at a point (see traverse.glsl). The share that passes is that of
// surface_optics for the straight and the refracted ray, without Fresnel.
ivec3 filter_detail(uint instance, uint primitive, float u, float v, float way, bool front, ivec3 own)
{
    if (SPEC_FILTER_DETAIL == 0u)
        return own;
    uint index = shade_index_of(instance, primitive);
    gpu_material m = fetch_material(fetch_material_index(index));
    if (SPEC_FILTER_DETAIL == FILTERS_ABSORB)
        return own + (front ? absorption_depth(m.absorption, way) : -absorption_depth(m.absorption, way));
    vec4 color = vertex_color(index, u, v);
    vec3 passes = m.transmission;
    vec3 base = m.diffuse * color.rgb;
    float metallic = m.metallic, opacity = m.opacity;
    if (is_textured(TEXTURES_TRANSMISSION, m.tex_transmission))
        passes *= sample_use(m.tex_transmission, index, u, v).r;
    if (is_textured(TEXTURES_DIFFUSE, m.tex_diffuse))
        base *= sample_use(m.tex_diffuse, index, u, v).rgb;
    if (SPEC_METAL_ROUGH != 0u && is_textured(TEXTURES_METAL_ROUGH, m.tex_metal_rough))
        metallic *= sample_use(m.tex_metal_rough, index, u, v).b;
    if (SPEC_METAL_ROUGH != 0u && m.model == MATERIAL_MODEL_METAL_ROUGH)
        passes *= base * (1.0 - metallic);
    if (is_textured(TEXTURES_OPACITY, m.tex_opacity))
        opacity = sample_opacity(m, index, u, v);
    bool blends = (m.flags & MATERIAL_BLEND) != 0u;
    float cover = blends ? clamp(opacity * color.a, 0.0, 1.0) : 1.0;
    ivec3 depth = filter_depth(1.0 - cover + cover * passes);
    if (SPEC_ABSORPTION != 0u && (m.flags & MATERIAL_THIN) == 0u) {
        ivec3 absorbed = absorption_depth(m.absorption, way);
        depth += front ? absorbed : -absorbed;
    }
    return depth;
}

#endif

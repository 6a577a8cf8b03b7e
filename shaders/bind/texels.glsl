// Samples of the textures of a material, at a point of a surface.
#ifndef BIND_TEXELS_GLSL
#define BIND_TEXELS_GLSL

#include "surface.glsl"

// Samples are known by a bit: TEXTURES_*, and these of the two maps that bend normals. The slope of
// a height map takes three samples, two of them one texel further along an axis of its image.
#define TEXELS_NORMAL       8u
#define TEXELS_HEIGHT       16u
#define TEXELS_HEIGHT_RIGHT 512u
#define TEXELS_HEIGHT_BELOW 1024u
#define TEXELS_HEIGHTS      (TEXELS_HEIGHT | TEXELS_HEIGHT_RIGHT | TEXELS_HEIGHT_BELOW)

// Samples of all textures of a material. Factors are 1 where it has no such texture.
struct Texels {
    vec3 diffuse, specular, emission, metal_rough;
    float specular_level, transmission;
    vec4 opacity;
    vec3 relief;         // of the normal map, as stored; or of the height map, in red
    vec2 heights_beside; // of the height map, one texel to the right and one below
};

// Samples texture `t` at `uv`, at the level of the footprint there: the mean of the squares of its
// two axes, in texels.
vec4 sample_footprint(Surface s, gpu_texture t, vec2 uv)
{
    if (SPEC_MINIFICATION == 0u)
        return sample_texture(t, uv);
    vec2 uv0, uv1, uv2, size = vec2(texture_size(t));
    fetch_uvs(s.shade_index, t.uv_set, uv0, uv1, uv2);
    uv1 -= uv0;
    uv2 -= uv0;
    vec2 d1 = vec2(dot(t.matrix.xy, uv1), dot(t.matrix.zw, uv1)) * size;
    vec2 d2 = vec2(dot(t.matrix.xy, uv2), dot(t.matrix.zw, uv2)) * size;
    vec3 squares = vec3(dot(d1, d1), dot(d1, d2), dot(d2, d2));
    return sample_minified(t, uv, dot(s.footprint, squares));
}

uint needed_where(bool compiled, uint bit, uint use)
{
    return compiled && use != TEXTURE_NONE ? bit : 0u;
}

// A bit for each sample that the material needs.
uint texels_needed(gpu_material m)
{
    bool height = m.tex_normal == TEXTURE_NONE && SPEC_NORMAL_MAPS != 0u;
    bool blends = SPEC_CUTOUTS != 0u && (m.flags & MATERIAL_BLEND) != 0u;
    uint needed = needed_where(true, TEXTURES_DIFFUSE, m.tex_diffuse) |
                  needed_where(true, TEXTURES_SPECULAR, m.tex_specular) |
                  needed_where(SPEC_EMISSION != 0u, TEXTURES_EMISSION, m.tex_emission) |
                  needed_where(SPEC_METAL_ROUGH != 0u || SPEC_HIGHLIGHTS != 0u,
                               TEXTURES_METAL_ROUGH, m.tex_metal_rough) |
                  needed_where(SPEC_METAL_ROUGH != 0u, TEXTURES_SPECULAR_LEVEL,
                               m.tex_specular_level) |
                  needed_where(SPEC_REFRACTION != 0u, TEXTURES_TRANSMISSION, m.tex_transmission) |
                  needed_where(blends, TEXTURES_OPACITY, m.tex_opacity);
    return (needed & SPEC_TEXTURES) |
           needed_where(SPEC_NORMAL_MAPS != 0u, TEXELS_NORMAL, m.tex_normal) |
           needed_where(height, TEXELS_HEIGHTS, m.tex_bump);
}

bool is_for(uint bit, uint slot)
{
    return (SPEC_TEXTURES & slot) != 0u && bit == slot;
}

// The use of the texture that a sample is taken from.
uint texel_use(gpu_material m, uint bit)
{
    uint use = m.tex_diffuse;
    use = is_for(bit, TEXTURES_SPECULAR) ? m.tex_specular : use;
    use = is_for(bit, TEXTURES_EMISSION) ? m.tex_emission : use;
    use = is_for(bit, TEXTURES_METAL_ROUGH) ? m.tex_metal_rough : use;
    use = is_for(bit, TEXTURES_SPECULAR_LEVEL) ? m.tex_specular_level : use;
    use = is_for(bit, TEXTURES_TRANSMISSION) ? m.tex_transmission : use;
    use = is_for(bit, TEXTURES_OPACITY) ? m.tex_opacity : use;
    if (SPEC_NORMAL_MAPS != 0u) {
        use = bit == TEXELS_NORMAL ? m.tex_normal : use;
        use = (bit & TEXELS_HEIGHTS) != 0u ? m.tex_bump : use;
    }
    return use;
}

void put_texel(uint bit, vec4 texel, inout Texels x)
{
    x.diffuse = is_for(bit, TEXTURES_DIFFUSE) ? texel.rgb : x.diffuse;
    x.specular = is_for(bit, TEXTURES_SPECULAR) ? texel.rgb : x.specular;
    x.emission = is_for(bit, TEXTURES_EMISSION) ? texel.rgb : x.emission;
    x.metal_rough = is_for(bit, TEXTURES_METAL_ROUGH) ? texel.rgb : x.metal_rough;
    x.specular_level = is_for(bit, TEXTURES_SPECULAR_LEVEL) ? texel.a : x.specular_level;
    x.transmission = is_for(bit, TEXTURES_TRANSMISSION) ? texel.r : x.transmission;
    x.opacity = is_for(bit, TEXTURES_OPACITY) ? texel : x.opacity;
    if (SPEC_NORMAL_MAPS != 0u) {
        x.relief = (bit & (TEXELS_NORMAL | TEXELS_HEIGHT)) != 0u ? texel.rgb : x.relief;
        x.heights_beside.x = bit == TEXELS_HEIGHT_RIGHT ? texel.r : x.heights_beside.x;
        x.heights_beside.y = bit == TEXELS_HEIGHT_BELOW ? texel.r : x.heights_beside.y;
    }
}

// Samples the texture of the lowest bit of `needed`, and takes that bit off.
void sample_next(Surface s, gpu_material m, inout uint needed, inout Texels x)
{
    uint bit = needed & (~needed + 1u);
    gpu_texture t = fetch_texture_use(texel_use(m, bit));
    if (SPEC_NORMAL_MAPS != 0u) {
        vec2 size = vec2(texture_size(t));
        t.offset.x += bit == TEXELS_HEIGHT_RIGHT ? 1.0 / size.x : 0.0;
        t.offset.y += bit == TEXELS_HEIGHT_BELOW ? 1.0 / size.y : 0.0;
    }
    put_texel(bit, sample_footprint(s, t, interpolate_uv(s.shade_index, t.uv_set, s.u, s.v)), x);
    needed ^= bit;
}

// Samples all textures of the material. If materials of the scene have several, each lane loops over
// those of its own: so the kernel has the code of a sample once, and a subgroup runs it as often as
// the material with the most textures asks.
Texels sample_texels_of(Surface s, gpu_material m)
{
    const bool several = SPEC_NORMAL_MAPS != 0u || (SPEC_TEXTURES & (SPEC_TEXTURES - 1u)) != 0u;
    Texels x = Texels(vec3(1.0), vec3(1.0), vec3(1.0), vec3(1.0), 1.0, 1.0, vec4(1.0), vec3(0.0),
                      vec2(0.0));
    uint needed = texels_needed(m);
    if (several) {
        while (needed != 0u)
            sample_next(s, m, needed, x);
    } else if (needed != 0u) {
        sample_next(s, m, needed, x);
    }
    return x;
}

// The directions in which u and v of a texture's image grow, in world space, not unit; zero where
// the texture is a point or a line on the triangle.
void texture_frame(Surface s, gpu_texture t, out vec3 tangent, out vec3 bitangent)
{
    vec2 uv0, uv1, uv2;
    fetch_uvs(s.shade_index, t.uv_set, uv0, uv1, uv2);
    uv1 -= uv0;
    uv2 -= uv0;
    vec2 d1 = vec2(dot(t.matrix.xy, uv1), dot(t.matrix.zw, uv1));
    vec2 d2 = vec2(dot(t.matrix.xy, uv2), dot(t.matrix.zw, uv2));
    float det = d1.x * d2.y - d1.y * d2.x;
    float inv = det != 0.0 ? 1.0 / det : 0.0;
    tangent = (s.e1 * d2.y - s.e2 * d1.y) * inv;
    bitangent = (s.e2 * d1.x - s.e1 * d2.x) * inv;
}

// Bends s.ns by a normal map in tangent space, or by the slope of a height map. Seen from behind, the
// bent normal is the reverse of that in front: what stands out there is a dent here.
void bend_normal(inout Surface s, gpu_material material, Texels x)
{
    bool is_map = material.tex_normal != TEXTURE_NONE;
    uint use = is_map ? material.tex_normal : material.tex_bump;
    if (use == TEXTURE_NONE)
        return;
    gpu_texture picture = fetch_texture_use(use);
    vec3 tangent, bitangent;
    texture_frame(s, picture, tangent, bitangent);
    tangent = s.turned ? -tangent : tangent;
    bitangent = s.turned ? -bitangent : bitangent;
    vec3 t = normalize_or(tangent - s.ns * dot(s.ns, tangent), vec3(0.0));
    vec3 b = normalize_or(bitangent - s.ns * dot(s.ns, bitangent), vec3(0.0));
    vec3 bent;
    if (is_map) {
        vec3 map = x.relief * 2.0 - 1.0;
        map.xy *= material.normal_scale;
        bent = t * map.x - b * map.y + s.ns * map.z;
    } else {
        // Heights are in units of 1/32 of the texture's side: MTL gives none.
        vec2 size = vec2(texture_size(picture)), rise = x.heights_beside - x.relief.r;
        vec2 slope = rise * size * (material.normal_scale / 32.0);
        bent = s.ns - t * slope.x - b * slope.y;
    }
    s.ns = normalize_or(bent, s.ns);
}

#endif

// Descriptors of what shading reads, with accessors: frame, materials, textures, lights, and the
// attributes of triangles.
#ifndef BIND_SHADING_GLSL
#define BIND_SHADING_GLSL

#include "../abi/bindings.h"
#include "../abi/shade.h"
#include "../abi/spec.h"
#include "../lib/load.glsl"

// A storage buffer, since lavapipe compiles values of uniform buffers that branches depend on into
// the kernel, as it does with push constants, and would compile anew for every dispatch.
layout(set = 0, binding = BIND_FRAME, std430) readonly buffer FrameBuffer
{
    gpu_frame stored_frame;
    float stored_sliders[SLIDERS_MAX];
};

// A copy that every kernel makes first (load_frame): within branches and loops lavapipe loads even
// uniform values lane by lane.
gpu_frame frame;

void load_frame()
{
    frame = stored_frame;
}

layout(set = 0, binding = BIND_SHADING, std430) readonly buffer ShadingBuffer
{
    uvec4 shading_rows[];
};
layout(set = 0, binding = BIND_SHADING_TEXELS) uniform usamplerBuffer shading_texels;
layout(set = 0, binding = BIND_TEXELS, std430) readonly buffer TexelBuffer { uvec4 texel_rows[]; };
layout(set = 0, binding = BIND_TEXEL_TEXELS) uniform usamplerBuffer texel_texels;

uvec4 fetch_shading_row(uint row)
{
    if (SPEC_LOAD_PATH == LOAD_TEXEL)
        return texelFetch(shading_texels, int(row));
    return shading_rows[row];
}

gpu_material fetch_material(uint index)
{
    uint row = index * MATERIAL_ROWS;
    uvec4 r0 = fetch_shading_row(row), r1 = fetch_shading_row(row + 1u);
    uvec4 r2 = fetch_shading_row(row + 2u), r3 = fetch_shading_row(row + 3u);
    uvec4 r4 = fetch_shading_row(row + 4u), r5 = fetch_shading_row(row + 5u);
    uvec4 r6 = fetch_shading_row(row + 6u), r7 = fetch_shading_row(row + 7u);
    uvec4 r8 = fetch_shading_row(row + 8u), r9 = fetch_shading_row(row + 9u);
    return gpu_material(row_vec3(r0), r0.w, row_vec3(r1), uintBitsToFloat(r1.w), row_vec3(r2),
                        uintBitsToFloat(r2.w), row_vec3(r3), r3.w, row_vec3(r4),
                        uintBitsToFloat(r4.w), row_vec3(r5), uintBitsToFloat(r5.w), row_vec3(r6),
                        uintBitsToFloat(r6.w), uintBitsToFloat(r7.x), uintBitsToFloat(r7.y),
                        uintBitsToFloat(r7.z), r7.w, r8.x, r8.y, r8.z, r8.w, r9.x, r9.y, r9.z, r9.w);
}

gpu_texture fetch_texture_use(uint index)
{
    uint row = frame.use_row + index * TEXTURE_ROWS;
    uvec4 r0 = fetch_shading_row(row), r1 = fetch_shading_row(row + 1u);
    uvec4 r2 = fetch_shading_row(row + 2u);
    return gpu_texture(uintBitsToFloat(r0), uintBitsToFloat(r1.xy), r1.z, r1.w, r2.x, r2.y, r2.z,
                       r2.w);
}

gpu_light fetch_light(uint index)
{
    uint row = frame.light_row + index * LIGHT_ROWS;
    uvec4 r0 = fetch_shading_row(row), r1 = fetch_shading_row(row + 1u);
    uvec4 r2 = fetch_shading_row(row + 2u), r3 = fetch_shading_row(row + 3u);
    vec3 edge_u = vec3(0.0), edge_v = vec3(0.0);
    float area_share = 0.0;
    if ((SPEC_LIGHTS & LIGHT_FLAT_BITS) != 0u) {
        uvec4 r4 = fetch_shading_row(row + 4u);
        edge_u = row_vec3(r4);
        area_share = uintBitsToFloat(r4.w);
        edge_v = row_vec3(fetch_shading_row(row + 5u));
    }
    return gpu_light(row_vec3(r0), r0.w, row_vec3(r1), uintBitsToFloat(r1.w), row_vec3(r2), r2.w,
                     uintBitsToFloat(r3.x), uintBitsToFloat(r3.y), r3.z, uintBitsToFloat(r3.w),
                     edge_u, area_share, edge_v, 0u);
}

uint triangle_rows_each()
{
    return SPEC_SMOOTH_NORMALS != 0u ? TRIANGLE_SHADE_ROWS : TRIANGLE_FLAT_ROWS;
}

// `shade_index`: index of the primitive among those of all meshes.
uint fetch_material_index(uint shade_index)
{
    return fetch_shading_row(frame.triangle_row + shade_index * triangle_rows_each()).w;
}

void fetch_uvs(uint shade_index, uint uv_set, out vec2 uv0, out vec2 uv1, out vec2 uv2)
{
    uint row = (uv_set != 0u ? frame.uv1_row : frame.uv0_row) + shade_index * TRIANGLE_UV_ROWS;
    uvec4 r0 = fetch_shading_row(row), r1 = fetch_shading_row(row + 1u);
    uv0 = uintBitsToFloat(r0.xy);
    uv1 = uintBitsToFloat(r0.zw);
    uv2 = uintBitsToFloat(r1.xy);
}

// One word of the texels; a row has four.
uint fetch_texel_word(uint word)
{
    uvec4 row = SPEC_LOAD_PATH == LOAD_TEXEL ? texelFetch(texel_texels, int(word >> 2))
                                             : texel_rows[word >> 2];
    uvec2 pair = (word & 2u) != 0u ? row.zw : row.xy;
    return (word & 1u) != 0u ? pair.y : pair.x;
}

// A texel in linear colour. A table decodes sRGB exactly, where pow() would be off by tens of ulp.
vec4 fetch_texel(uint word, bool srgb)
{
    uint texel = fetch_texel_word(word);
    vec4 linear = unpackUnorm4x8(texel);
    if ((SPEC_SAMPLING & SAMPLING_SRGB) != 0u && srgb) {
        linear.r = uintBitsToFloat(fetch_texel_word(texel & 255u));
        linear.g = uintBitsToFloat(fetch_texel_word((texel >> 8) & 255u));
        linear.b = uintBitsToFloat(fetch_texel_word((texel >> 16) & 255u));
    }
    return linear;
}

// Whether this texture, of wrap mode `wrap`, wraps by mode `way`. A constant where all textures
// have one mode.
bool wraps(uint way, uint wrap)
{
    const uint ways = SPEC_SAMPLING & (SAMPLING_REPEAT | SAMPLING_CLAMP | SAMPLING_MIRROR);
    uint bit = SAMPLING_REPEAT << way;
    return (ways & bit) != 0u && (ways == bit || wrap == way);
}

// The texel, 0 .. size - 1, that texel `at` stands for by the wrap mode. Where the texture repeats,
// `at` is in -1 .. 2 size. There is no division, which devices may round to another whole number.
int wrap_texel(int at, int size, uint wrap)
{
    int chosen = at;
    if (wraps(WRAP_REPEAT, wrap)) {
        chosen = at < 0 ? at + size : at;
        chosen -= chosen >= size ? size : 0;
        chosen -= chosen >= size ? size : 0;
    }
    if (wraps(WRAP_MIRROR, wrap)) {
        int period = at < 0 ? at + 2 * size : at;
        period -= period >= 2 * size ? 2 * size : 0;
        chosen = period < size ? period : 2 * size - 1 - period;
    }
    return clamp(chosen, 0, size - 1);
}

// Takes off whole periods, so that coordinates far from 0 cannot overflow an int. The fraction of
// such a coordinate has only the digits that its float has left.
float reduce_coordinate(float x, uint wrap)
{
    float reduced = wraps(WRAP_CLAMP, wrap) ? clamp(x, -1.0, 2.0) : x - 2.0 * floor(x * 0.5);
    return abs(reduced) <= 2.0 ? reduced : 0.0;
}

// The place of `uv` in the texture's image, whose sides are 1: whole periods are taken off.
vec2 place_in_picture(gpu_texture t, vec2 uv)
{
    vec2 at = vec2(t.matrix.x * uv.x + t.matrix.y * uv.y, t.matrix.z * uv.x + t.matrix.w * uv.y) +
              t.offset;
    return vec2(reduce_coordinate(at.x, t.wrap & 3u), reduce_coordinate(at.y, (t.wrap >> 2) & 3u));
}

// A value from a to b; their own where they are equal, as an alpha that equals the cutoff may be,
// which roundings of mix() would cut out.
vec4 between(vec4 a, vec4 b, float part)
{
    return a + (b - a) * part;
}

// Samples a level of texture `t`, which has `size` texels from word `first` on, at a place in its
// image.
vec4 sample_texels(gpu_texture t, uint first, ivec2 size, vec2 at)
{
    uvec2 wrap = uvec2(t.wrap & 3u, (t.wrap >> 2) & 3u);
    at *= vec2(size);
    bool filtered = (SPEC_SAMPLING & SAMPLING_FILTERED) != 0u && t.nearest == 0u;
    vec2 corner = filtered ? floor(at - 0.5) : floor(at);
    vec2 part = filtered ? at - 0.5 - corner : vec2(0.0);
    ivec2 texel = ivec2(corner);
    uint x0 = uint(wrap_texel(texel.x, size.x, wrap.x));
    uint y0 = first + uint(wrap_texel(texel.y, size.y, wrap.y) * size.x);
    bool srgb = t.srgb != 0u;
    vec4 color = fetch_texel(y0 + x0, srgb);
    if ((SPEC_SAMPLING & SAMPLING_FILTERED) == 0u)
        return color;
    uint x1 = uint(wrap_texel(texel.x + 1, size.x, wrap.x));
    uint y1 = first + uint(wrap_texel(texel.y + 1, size.y, wrap.y) * size.x);
    vec4 top = between(color, fetch_texel(y0 + x1, srgb), part.x);
    vec4 bottom = between(fetch_texel(y1 + x0, srgb), fetch_texel(y1 + x1, srgb), part.x);
    return between(top, bottom, part.y);
}

ivec2 texture_size(gpu_texture t)
{
    return ivec2(int(t.size & 0xffffu), int(t.size >> 16));
}

// Samples level 0 of a texture.
vec4 sample_texture(gpu_texture t, vec2 uv)
{
    return sample_texels(t, t.first, texture_size(t), place_in_picture(t, uv));
}

// The mipmap level whose texels cover `texels` of level 0: half the binary logarithm, by a table of
// straight pieces, since drivers' own logarithms differ. It is mipmap_level of
// host/picture/mipmap.c.
float mip_level(float texels)
{
    uint bits = floatBitsToUint(texels);
    uint word = TEXEL_CODES + 2u * ((bits >> 19) & (LEVEL_PIECES - 1u));
    float start = uintBitsToFloat(fetch_texel_word(word));
    float slope = uintBitsToFloat(fetch_texel_word(word + 1u));
    float along = float(bits & 0x7ffffu) * (1.0 / 524288.0);
    float exponent = float(int(bits >> 23) - 127);
    return texels > 1.0 ? 0.5 * exponent + (start + slope * along) : 0.0;
}

// Interpolates between the two levels whose texels cover about `texels` of level 0.
vec4 sample_minified(gpu_texture t, vec2 uv, float texels)
{
    ivec2 size = texture_size(t);
    float level = min(mip_level(texels), float(t.wrap >> TEXTURE_LEVELS_SHIFT));
    uint k = uint(level);
    float part = level - float(k);
    vec2 at = place_in_picture(t, uv);
    uint table = t.first + uint(size.x * size.y) - 1u;
    vec4 color = vec4(0.0);
    bool more = true, second = false;
    // A loop, so that lavapipe reads a second level only where some lane of a subgroup needs one.
    // The other lanes run through it too, and must keep their values.
    do {
        uint first = k == 0u ? t.first : fetch_texel_word(table + k);
        vec4 texel = sample_texels(t, first, max(size >> int(k), ivec2(1)), at);
        vec4 mixed = second ? between(color, texel, part) : texel;
        color = more ? mixed : color;
        more = more && !second && part > 0.0;
        second = true;
        k += uint(more);
    } while (more);
    return color;
}

// `slot`: TEXTURES_*.
bool is_textured(uint slot, uint use)
{
    return (SPEC_TEXTURES & slot) != 0u && use != TEXTURE_NONE;
}

vec2 interpolate_uv(uint shade_index, uint uv_set, float u, float v)
{
    vec2 uv0, uv1, uv2;
    fetch_uvs(shade_index, uv_set, uv0, uv1, uv2);
    return uv0 * (1.0 - u - v) + uv1 * u + uv2 * v;
}

// Texture `use` at a point of a triangle, at level 0.
vec4 sample_use(uint use, uint shade_index, float u, float v)
{
    gpu_texture t = fetch_texture_use(use);
    return sample_texture(t, interpolate_uv(shade_index, t.uv_set, u, v));
}

float opacity_of(gpu_material material, vec4 texel)
{
    return material.opacity *
           ((material.flags & MATERIAL_OPACITY_ALPHA) != 0u ? texel.a : texel.r);
}

float sample_opacity(gpu_material material, uint shade_index, float u, float v)
{
    return opacity_of(material, sample_use(material.tex_opacity, shade_index, u, v));
}

#endif

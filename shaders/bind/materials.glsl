// Descriptors of materials and textures, with accessors.
#ifndef BIND_MATERIALS_GLSL
#define BIND_MATERIALS_GLSL

#include "../abi/bindings.h"
#include "../abi/shade.h"
#include "../abi/spec.h"
#include "trees.glsl"

layout(set = 0, binding = BIND_MATERIALS, std430) readonly buffer MaterialBuffer
{
    gpu_material materials[];
};
layout(set = 0, binding = BIND_TEXTURES, std430) readonly buffer TextureBuffer
{
    gpu_texture textures[];
};
layout(set = 0, binding = BIND_TEXELS, std430) readonly buffer TexelBuffer { uvec4 texel_rows[]; };
layout(set = 0, binding = BIND_TEXEL_TEXELS) uniform usamplerBuffer texel_texels;
layout(set = 0, binding = BIND_TRIANGLE_UVS, std430) readonly buffer TriangleUvBuffer
{
    vec2 triangle_uvs[]; // 3 per triangle; set 1 behind set 0
};

// Four words share a row.
uint fetch_texel_word(uint word)
{
    uvec4 row = SPEC_LOAD_PATH == LOAD_TEXEL ? texelFetch(texel_texels, int(word >> 2))
                                             : texel_rows[word >> 2];
    uvec2 pair = (word & 2u) != 0u ? row.zw : row.xy;
    return (word & 1u) != 0u ? pair.y : pair.x;
}

// Linear: a table decodes sRGB exactly, where pow() would be off by tens of ulp.
vec4 fetch_texel(uint word, bool srgb)
{
    uint texel = fetch_texel_word(word);
    vec4 linear = unpackUnorm4x8(texel);
    if (srgb) {
        linear.r = uintBitsToFloat(fetch_texel_word(texel & 255u));
        linear.g = uintBitsToFloat(fetch_texel_word((texel >> 8) & 255u));
        linear.b = uintBitsToFloat(fetch_texel_word((texel >> 16) & 255u));
    }
    return linear;
}

int wrap_texel(int at, int size, uint wrap)
{
    int clamped = clamp(at, 0, size - 1);
    int repeated = at - size * int(floor(float(at) / float(size)));
    int period = at - 2 * size * int(floor(float(at) / float(2 * size)));
    int mirrored = period < size ? period : 2 * size - 1 - period;
    int chosen = wrap == WRAP_CLAMP ? clamped : wrap == WRAP_MIRROR ? mirrored : repeated;
    return clamp(chosen, 0, size - 1);
}

// Whole periods taken off first, so that far coordinates keep their fraction and cannot overflow
// an int.
float reduce_coordinate(float x, uint wrap)
{
    float reduced = wrap == WRAP_CLAMP ? clamp(x, -1.0, 2.0) : x - 2.0 * floor(x * 0.5);
    return abs(reduced) <= 2.0 ? reduced : 0.0;
}

vec4 sample_texture(uint use, vec2 uv)
{
    gpu_texture t = textures[use];
    ivec2 size = ivec2(int(t.size & 0xffffu), int(t.size >> 16));
    uvec2 wrap = uvec2(t.wrap & 3u, (t.wrap >> 2) & 3u);
    vec2 at = vec2(t.matrix.x * uv.x + t.matrix.y * uv.y, t.matrix.z * uv.x + t.matrix.w * uv.y) +
              t.offset;
    at = vec2(reduce_coordinate(at.x, wrap.x), reduce_coordinate(at.y, wrap.y)) * vec2(size);
    vec2 corner = t.nearest != 0u ? floor(at) : floor(at - 0.5);
    vec2 part = t.nearest != 0u ? vec2(0.0) : at - 0.5 - corner;
    ivec2 texel = ivec2(corner);
    uint x0 = uint(wrap_texel(texel.x, size.x, wrap.x));
    uint x1 = uint(wrap_texel(texel.x + 1, size.x, wrap.x));
    uint y0 = t.first + uint(wrap_texel(texel.y, size.y, wrap.y) * size.x);
    uint y1 = t.first + uint(wrap_texel(texel.y + 1, size.y, wrap.y) * size.x);
    bool srgb = t.srgb != 0u;
    vec4 top = mix(fetch_texel(y0 + x0, srgb), fetch_texel(y0 + x1, srgb), part.x);
    vec4 bottom = mix(fetch_texel(y1 + x0, srgb), fetch_texel(y1 + x1, srgb), part.x);
    return mix(top, bottom, part.y);
}

// `shade_index`: index of the triangle in the per-triangle arrays.
vec2 interpolate_uv(uint shade_index, uint uv_set, uint triangle_total, float u, float v)
{
    uint first = (shade_index + uv_set * triangle_total) * 3u;
    return triangle_uvs[first] * (1.0 - u - v) + triangle_uvs[first + 1u] * u +
           triangle_uvs[first + 2u] * v;
}

float sample_opacity(gpu_material material, vec2 uv)
{
    vec4 texel = sample_texture(material.tex_opacity, uv);
    return material.opacity *
           ((material.flags & MATERIAL_OPACITY_ALPHA) != 0u ? texel.a : texel.r);
}

// Defined by the kernel: whether a cut-out triangle is solid at a point.
bool cutout_is_solid(uint instance, uint primitive, float u, float v);

#endif

// From a hit to what shading needs: point, normals, texture coordinates, material.
#ifndef BIND_SURFACE_GLSL
#define BIND_SURFACE_GLSL

#include "../lib/spawn.glsl"
#include "shading.glsl"
#include "traverse.glsl"

struct Surface {
    vec3 p, error; // world; bound of the error of p
    vec3 ng;       // unit geometric normal, to the outside of closed meshes
    vec3 ns;       // unit shading normal, on the side of ng
    vec3 tangent, bitangent; // of texture set 0 in u and v; not unit
    vec3 color;              // of the vertices
    float color_alpha;
    uint shade_index; // in the per-triangle arrays
    uint material;
    float u, v;
};

uint shade_index_of(uint instance, uint primitive)
{
    if (SPEC_INSTANCED == 0u)
        return frame.shade_base + primitive;
    return fetch_instance_row(instance * INSTANCE_ROWS + 3u).y + primitive;
}

bool cutout_is_solid(uint instance, uint primitive, float u, float v)
{
    uint index = shade_index_of(instance, primitive);
    gpu_material material = fetch_material(fetch_material_index(index));
    if ((material.flags & MATERIAL_MASK) == 0u)
        return true;
    if (material.tex_opacity == TEXTURE_NONE)
        return material.opacity >= material.alpha_cutoff;
    return sample_opacity(material, index, u, v) >= material.alpha_cutoff;
}

// Zero where the mesh is flat.
vec3 smooth_normal(uint shade_index, float u, float v)
{
    uint row = frame.triangle_row + shade_index * TRIANGLE_SHADE_ROWS;
    vec3 n0 = row_vec3(fetch_shading_row(row));
    vec3 n1 = row_vec3(fetch_shading_row(row + 1u));
    vec3 n2 = row_vec3(fetch_shading_row(row + 2u));
    return n0 * (1.0 - u - v) + n1 * u + n2 * v;
}

// Directions in which u and v of the texture grow, in object space.
void texture_frame(uint shade_index, vec3 e1, vec3 e2, out vec3 tangent, out vec3 bitangent)
{
    vec2 t0, t1, t2;
    fetch_uvs(shade_index, 0u, t0, t1, t2);
    vec2 d1 = t1 - t0;
    vec2 d2 = t2 - t0;
    float det = d1.x * d2.y - d1.y * d2.x;
    float inv = det != 0.0 ? 1.0 / det : 0.0;
    tangent = (e1 * d2.y - e2 * d1.y) * inv;
    bitangent = (e2 * d1.x - e1 * d2.x) * inv;
}

vec3 normalize_or(vec3 v, vec3 otherwise)
{
    float size = max(abs(v.x), max(abs(v.y), abs(v.z)));
    if (!(size > 0.0) || size > FLOAT_LARGEST)
        return otherwise;
    return normalize(v / size);
}

// Point and error bound to world space; the bound covers the way back by the inverse too.
void place_point(InstanceFrame inverse, vec3 f0, vec3 f1, vec3 f2, inout vec3 p, inout vec3 error)
{
    vec3 turned = rotate_rows(f0, f1, f2, p);
    vec3 size = vec3(dot(abs(f0), abs(p)), dot(abs(f1), abs(p)), dot(abs(f2), abs(p)));
    vec3 carried = vec3(dot(abs(f0), error), dot(abs(f1), error), dot(abs(f2), error));
    vec3 back = vec3(dot(abs(inverse.inverse0), size), dot(abs(inverse.inverse1), size),
                     dot(abs(inverse.inverse2), size));
    vec3 returned = vec3(dot(abs(f0), back), dot(abs(f1), back), dot(abs(f2), back));
    p = turned + inverse.origin;
    error = carried * (1.0 + rounding_bound(4.0)) + rounding_bound(4.0) * (size + returned) +
            rounding_bound(2.0) * abs(p);
}

Surface fetch_surface(Hit hit)
{
    Surface s;
    uint row = hit.triangle * TRIANGLE_ROWS;
    vec3 v0 = row_vec3(fetch_triangle_row(row));
    vec3 v1 = row_vec3(fetch_triangle_row(row + 1u));
    vec3 v2 = row_vec3(fetch_triangle_row(row + 2u));
    s.u = clamp(hit.u, 0.0, 1.0);
    s.v = clamp(hit.v, 0.0, 1.0 - s.u);
    float w = 1.0 - s.u - s.v;
    vec3 e1 = v1 - v0;
    vec3 e2 = v2 - v0;
    vec3 p0 = v0 * w, p1 = v1 * s.u, p2 = v2 * s.v;
    s.p = p0 + p1 + p2;
    s.error = rounding_bound(7.0) * (abs(p0) + abs(p1) + abs(p2));
    s.shade_index = shade_index_of(hit.instance, hit.primitive);
    s.material = fetch_material_index(s.shade_index);
    float scale = max(max(abs(e1.x), max(abs(e1.y), abs(e1.z))),
                      max(abs(e2.x), max(abs(e2.y), abs(e2.z))));
    vec3 ng = cross(e1 / scale, e2 / scale);
    vec3 ns = SPEC_SMOOTH_NORMALS != 0u ? smooth_normal(s.shade_index, s.u, s.v) : ng;
    s.tangent = vec3(0.0);
    s.bitangent = vec3(0.0);
    if (SPEC_NORMAL_MAPS != 0u)
        texture_frame(s.shade_index, e1, e2, s.tangent, s.bitangent);
    if (SPEC_INSTANCED != 0u) {
        InstanceFrame inverse = fetch_instance_frame(hit.instance);
        vec3 f0 = row_vec3(fetch_instance_row(hit.instance * INSTANCE_ROWS + 4u));
        vec3 f1 = row_vec3(fetch_instance_row(hit.instance * INSTANCE_ROWS + 5u));
        vec3 f2 = row_vec3(fetch_instance_row(hit.instance * INSTANCE_ROWS + 6u));
        place_point(inverse, f0, f1, f2, s.p, s.error);
        vec3 c0 = vec3(inverse.inverse0.x, inverse.inverse1.x, inverse.inverse2.x);
        vec3 c1 = vec3(inverse.inverse0.y, inverse.inverse1.y, inverse.inverse2.y);
        vec3 c2 = vec3(inverse.inverse0.z, inverse.inverse1.z, inverse.inverse2.z);
        ng = rotate_rows(c0, c1, c2, ng);
        ns = rotate_rows(c0, c1, c2, ns);
        s.tangent = rotate_rows(f0, f1, f2, s.tangent);
        s.bitangent = rotate_rows(f0, f1, f2, s.bitangent);
    }
    s.ng = normalize_or(ng, vec3(0.0, 1.0, 0.0));
    s.ns = normalize_or(ns, s.ng);
    s.color = vec3(1.0);
    s.color_alpha = 1.0;
    if (SPEC_VERTEX_COLORS != 0u) {
        uint color_row = frame.color_row + s.shade_index * TRIANGLE_COLOR_ROWS;
        uvec4 ab = fetch_shading_row(color_row);
        uvec4 c = fetch_shading_row(color_row + 1u);
        vec4 first = vec4(unpackUnorm2x16(ab.x), unpackUnorm2x16(ab.y));
        vec4 second = vec4(unpackUnorm2x16(ab.z), unpackUnorm2x16(ab.w));
        vec4 third = vec4(unpackUnorm2x16(c.x), unpackUnorm2x16(c.y));
        // By differences: three equal colours give just that colour.
        vec4 mixed = first + (second - first) * s.u + (third - first) * s.v;
        s.color = mixed.rgb;
        s.color_alpha = mixed.a;
    }
    return s;
}

vec4 sample_use(Surface s, uint use)
{
    return sample_use(use, s.shade_index, s.u, s.v);
}

// Bends s.ns by a tangent-space map or by the slope of a height map.
void bend_normal(inout Surface s, gpu_material material)
{
    if (material.tex_normal == TEXTURE_NONE && material.tex_bump == TEXTURE_NONE)
        return;
    vec3 t = normalize_or(s.tangent - s.ns * dot(s.ns, s.tangent), vec3(0.0));
    vec3 b = normalize_or(s.bitangent - s.ns * dot(s.ns, s.bitangent), vec3(0.0));
    vec3 bent = s.ns;
    if (material.tex_normal != TEXTURE_NONE) {
        vec3 map = sample_use(s, material.tex_normal).rgb * 2.0 - 1.0;
        map.xy *= material.normal_scale;
        bent = t * map.x - b * map.y + s.ns * map.z;
    } else {
        gpu_texture texture_use = fetch_texture_use(material.tex_bump);
        vec2 uv = interpolate_uv(s.shade_index, texture_use.uv_set, s.u, s.v);
        vec2 size = vec2(float(texture_use.size & 0xffffu), float(texture_use.size >> 16));
        vec2 texel = 1.0 / size;
        float at = sample_texture(texture_use, uv).r;
        float du = sample_texture(texture_use, uv + vec2(texel.x, 0.0)).r - at;
        float dv = sample_texture(texture_use, uv + vec2(0.0, texel.y)).r - at;
        // Heights are in units of 1/32 of the texture's side: MTL gives none.
        vec2 slope = vec2(du, dv) * size * (material.normal_scale / 32.0);
        bent = s.ns - t * slope.x - b * slope.y;
    }
    s.ns = normalize_or(bent, s.ns);
}

#endif

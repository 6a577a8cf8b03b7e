// Computes from a hit what shading needs: point, normals, texture coordinates, material.
#ifndef BIND_SURFACE_GLSL
#define BIND_SURFACE_GLSL

#include "../lib/records.glsl"
#include "../lib/spawn.glsl"
#include "shading.glsl"
#include "traverse.glsl"

uint shade_index_of(uint instance, uint primitive)
{
    if (SPEC_INSTANCED == 0u && SPEC_FLAT == 0u)
        return frame.shade_base + primitive;
    return fetch_instance_row(instance * INSTANCE_ROWS + 3u).y + primitive;
}

// Linear RGBA at a point of a triangle.
vec4 vertex_color(uint shade_index, float u, float v)
{
    if (SPEC_VERTEX_COLORS == 0u)
        return vec4(1.0);
    uint color_row = frame.color_row + shade_index * TRIANGLE_COLOR_ROWS;
    uvec4 ab = fetch_shading_row(color_row);
    uvec4 c = fetch_shading_row(color_row + 1u);
    vec4 first = vec4(unpackUnorm2x16(ab.x), unpackUnorm2x16(ab.y));
    vec4 second = vec4(unpackUnorm2x16(ab.z), unpackUnorm2x16(ab.w));
    vec4 third = vec4(unpackUnorm2x16(c.x), unpackUnorm2x16(c.y));
    // In differences, so that three equal colours give exactly that colour.
    return first + (second - first) * u + (third - first) * v;
}

bool cutout_is_solid(uint instance, uint primitive, float u, float v)
{
    uint index = shade_index_of(instance, primitive);
    gpu_material material = fetch_material(fetch_material_index(index));
    if ((material.flags & MATERIAL_MASK) == 0u)
        return true;
    float opacity = material.opacity;
    if (is_textured(TEXTURES_OPACITY, material.tex_opacity))
        opacity = sample_opacity(material, index, u, v);
    return opacity * vertex_color(index, u, v).a >= material.alpha_cutoff;
}

// The interpolated vertex normal; zero where the mesh is flat.
vec3 smooth_normal(uint shade_index, float u, float v)
{
    uint row = frame.triangle_row + shade_index * TRIANGLE_SHADE_ROWS;
    vec3 n0 = row_vec3(fetch_shading_row(row));
    vec3 n1 = row_vec3(fetch_shading_row(row + 1u));
    vec3 n2 = row_vec3(fetch_shading_row(row + 2u));
    return n0 * (1.0 - u - v) + n1 * u + n2 * v;
}

vec3 normalize_or(vec3 v, vec3 otherwise)
{
    float size = max(abs(v.x), max(abs(v.y), abs(v.z)));
    if (!(size > 0.0) || size > FLOAT_LARGEST)
        return otherwise;
    return normalize(v / size);
}

// Transforms a point and its error bound to world space. The bound also covers a later transform
// back by the inverse.
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

// Transforms a normal to world space, by the inverse transpose.
vec3 place_normal(InstanceFrame inverse, vec3 n)
{
    vec3 c0 = vec3(inverse.inverse0.x, inverse.inverse1.x, inverse.inverse2.x);
    vec3 c1 = vec3(inverse.inverse0.y, inverse.inverse1.y, inverse.inverse2.y);
    vec3 c2 = vec3(inverse.inverse0.z, inverse.inverse1.z, inverse.inverse2.z);
    return rotate_rows(c0, c1, c2, n);
}

// Fills in the surface of a hit triangle, in the record's space; normals are not of unit length.
void fetch_on_triangle(Hit hit, inout Surface s)
{
    uint row = hit.triangle * TRIANGLE_ROWS;
    vec3 v0 = row_vec3(fetch_triangle_row(row));
    vec3 v1 = row_vec3(fetch_triangle_row(row + 1u));
    vec3 v2 = row_vec3(fetch_triangle_row(row + 2u));
    s.u = clamp(hit.u, 0.0, 1.0);
    s.v = clamp(hit.v, 0.0, 1.0 - s.u);
    float w = 1.0 - s.u - s.v;
    s.e1 = v1 - v0;
    s.e2 = v2 - v0;
    vec3 p0 = v0 * w, p1 = v1 * s.u, p2 = v2 * s.v;
    s.p = p0 + p1 + p2;
    s.error = rounding_bound(7.0) * (abs(p0) + abs(p1) + abs(p2));
    float scale = max(max(abs(s.e1.x), max(abs(s.e1.y), abs(s.e1.z))),
                      max(abs(s.e2.x), max(abs(s.e2.y), abs(s.e2.z))));
    s.ng = cross(s.e1 / scale, s.e2 / scale);
    s.ns = SPEC_SMOOTH_NORMALS != 0u ? smooth_normal(s.shade_index, s.u, s.v) : s.ng;
}

// Fills in the surface of a hit sphere. The point is put on the sphere along its normal n, not at
// the ray's t: p = c + r n. The rounded length of n (three products and sums, whose error the root
// halves, 9 roundings of the root and 5 of the division at Vulkan's precision: 16) and the product
// put p off by at most gamma(17) r |n|, the sum by one rounding of p. u and v are texture
// coordinates, and e1 and e2 the derivatives of p by them; the sphere's record has the coordinates
// (0, 0), (1, 0), (0, 1), so that interpolation returns u and v themselves.
void fetch_on_sphere(Hit hit, inout Surface s)
{
    const float pi = 3.14159265;
    uint row = hit.triangle * TRIANGLE_ROWS;
    vec3 center = row_vec3(fetch_triangle_row(row));
    float radius = uintBitsToFloat(fetch_triangle_row(row + 1u).x);
    vec3 n = dir_from_square(vec2(hit.u, hit.v));
    n /= sqrt(dot(n, n));
    vec3 arm = n * radius;
    s.p = center + arm;
    s.error = rounding_bound(17.0) * abs(arm) + rounding_bound(1.0) * abs(s.p);
    s.ng = n;
    s.ns = n;
    float ring = sqrt(n.x * n.x + n.z * n.z);
    vec3 around = ring > 0.0 ? vec3(n.z, 0.0, -n.x) / ring : vec3(0.0);
    s.e1 = around * (2.0 * pi * radius * ring);
    s.e2 = cross(around, n) * (pi * radius);
    vec2 uv = sphere_uv(n);
    s.u = uv.x;
    s.v = uv.y;
}

bool is_on_sphere(Hit hit)
{
    return SPEC_SPHERES != SPHERES_NONE &&
           (fetch_triangle_row(hit.triangle * TRIANGLE_ROWS + 1u).w & TRIANGLE_SPHERE) != 0u;
}

// The ray of the hit that fetch_surface() is called for: needed where it hit a user's shape, which
// has no record.
vec3 met_origin, met_dir;

// Sets the surface of a hit on a user's shape at `t`; `square`: its normal, by square_from_dir().
void put_on_shape(float t, vec2 square, inout Surface s)
{
    s.p = met_origin + met_dir * t;
    s.error = vec3(2.0 * frame.shape_error) + rounding_bound(8.0) * (abs(met_origin) + abs(met_dir * t));
    vec3 n = dir_from_square(square);
    s.ng = n / sqrt(dot(n, n));
    s.ns = s.ng;
    vec3 aside = abs(s.ng.x) < 0.6 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    s.e1 = normalize(cross(s.ng, aside));
    s.e2 = cross(s.ng, s.e1);
    s.color = vec3(1.0);
    s.color_alpha = 1.0;
    s.shade_index = 0u;
    s.instance = HIT_SHAPE;
    s.on_sphere = true; // as on spheres, no vertices count
    s.material = frame.shape_material & ~SHAPE_IS_GLASS;
    s.u = 0.0;
    s.v = 0.0;
}

Surface fetch_surface(Hit hit)
{
    Surface s;
    Hit own = hit;
    bool on_shape = (SPEC_HOOKS & HOOK_INTERSECT) != 0u && hit.triangle == HIT_SHAPE;
    if (on_shape) // what is fetched below is not used; any primitive will do
        hit.triangle = hit.instance = hit.primitive = 0u;
    uint row = hit.triangle * TRIANGLE_ROWS;
    s.shade_index = shade_index_of(hit.instance, hit.primitive);
    s.instance = hit.instance;
    s.on_sphere = is_on_sphere(hit);
    s.turned = false;
    s.material = fetch_material_index(s.shade_index);
    if (SPEC_SPHERES != SPHERES_ONLY)
        fetch_on_triangle(hit, s);
    if (SPEC_SPHERES == SPHERES_ONLY || is_on_sphere(hit)) // a constant where there are no spheres
        fetch_on_sphere(hit, s);
    vec3 ng = s.ng, ns = s.ns;
    if (SPEC_INSTANCED != 0u) {
        InstanceFrame inverse = fetch_instance_frame(hit.instance);
        vec3 f0 = row_vec3(fetch_instance_row(hit.instance * INSTANCE_ROWS + 4u));
        vec3 f1 = row_vec3(fetch_instance_row(hit.instance * INSTANCE_ROWS + 5u));
        vec3 f2 = row_vec3(fetch_instance_row(hit.instance * INSTANCE_ROWS + 6u));
        place_point(inverse, f0, f1, f2, s.p, s.error);
        ng = place_normal(inverse, ng);
        ns = place_normal(inverse, ns);
        if (SPEC_NORMAL_MAPS != 0u || SPEC_MEDIA != 0u || SPEC_TERMINATOR != 0u ||
            SPEC_MINIFICATION != 0u) {
            s.e1 = rotate_rows(f0, f1, f2, s.e1);
            s.e2 = rotate_rows(f0, f1, f2, s.e2);
        }
    }
    // Vertices of a flat tree are in world space; vertex normals are in object space.
    if (SPEC_FLAT != 0u) {
        bool mirrored = (fetch_triangle_row(row + 1u).w & TRIANGLE_MIRRORED) != 0u;
        ng = mirrored ? -ng : ng;
        ns = SPEC_SMOOTH_NORMALS != 0u ? place_normal(fetch_instance_frame(hit.instance), ns) : ng;
    }
    s.ng = normalize_or(ng, vec3(0.0, 1.0, 0.0));
    s.ns = normalize_or(ns, s.ng);
    vec4 color = vertex_color(s.shade_index, s.u, s.v);
    s.color = color.rgb;
    s.color_alpha = color.a;
    s.footprint = vec3(0.0);
    if (on_shape)
        put_on_shape(own.t, vec2(own.u, own.v), s);
    return s;
}

// Sets s.footprint for a ray along `dir` with the cross section `area` where it hits the surface. A
// parallel ray at offset `a` hits the plane of e1 and e2 at dot(along1, a) e1 + dot(along2, a) e2
// from there. A texture that moves by d1 and d2 along these edges then moves by J a, and half the
// trace of J transposed J is the mean of the squares of the ellipse's axes: the sum of the three
// parts times d1 d1, d1 d2 and d2 d2.
//
// Lengths are in units of a power of two near that of the edges, so that their fourth powers are in
// the range of floats, with the same bits.
void take_footprint(inout Surface s, vec3 dir, float area)
{
    vec3 edges = max(abs(s.e1), abs(s.e2));
    uint size = floatBitsToUint(max(edges.x, max(edges.y, edges.z))) & 0x7f800000u;
    float unit = uintBitsToFloat(0x7f000000u - size); // 1 / 2^e
    vec3 e1 = s.e1 * unit, e2 = s.e2 * unit;
    area = area * unit * unit;
    vec3 along1 = cross(e2, dir), along2 = cross(dir, e1);
    float seen = dot(cross(e1, e2), dir);
    vec3 parts = vec3(dot(along1, along1), 2.0 * dot(along1, along2), dot(along2, along2));
    s.footprint = parts * (0.5 * area / (seen * seen));
}

// Turns the normals to the ray's side. True: the ray comes from inside.
bool face_ray(inout Surface s, vec3 dir)
{
    bool inside = dot(dir, s.ng) > 0.0;
    if (inside) {
        s.ng = -s.ng;
        s.ns = -s.ns;
    }
    s.turned = inside;
    if (dot(s.ns, s.ng) < 0.0) {
        s.ns = -s.ns;
        s.turned = !inside;
    }
    if (dot(s.ns, dir) > 0.0)
        s.ns = s.ng;
    return inside;
}

#endif

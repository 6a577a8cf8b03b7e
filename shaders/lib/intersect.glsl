// Tests of boxes and triangles against a ray. Every product and sum is `precise`: rounded once,
// never contracted, so that neighbours decide a shared edge alike and C gives the same bits
// (docs/numerics.md). twin/intersect.h is this file in C.
#ifndef LIB_INTERSECT_GLSL
#define LIB_INTERSECT_GLSL

#include "../abi/spec.h"
#include "turn.glsl"

// Values that the tests of all boxes and triangles share for a ray.
struct RaySetup {
    vec3 origin, dir;
    vec3 above, below; // origin plus and minus the margin of node boxes: see widen_ray_setup
    vec3 inv_dir;  // infinite where the direction is 0
    bvec3 negative; // inv_dir < 0, so that -0 counts as negative
    bvec2 space;    // how the ray's space is turned against that of the tree: see turn_dominant
    bvec2 dominant; // |dir| is largest along x; along y
    vec3 shear;    // Woop, Benthin and Wald 2013: dir.x / dir.z, dir.y / dir.z, 1 / dir.z after
                   // turning the dominant axis to z
};

// Permutes (x, y, z) cyclically so that the dominant axis comes last; this keeps orientation.
vec3 turn_dominant(bvec2 dominant, vec3 p)
{
    return dominant.x ? p.yzx : dominant.y ? p.zxy : p;
}

RaySetup make_ray_setup(vec3 origin, vec3 dir)
{
    RaySetup ray;
    ray.origin = origin;
    ray.dir = dir;
    ray.above = origin;
    ray.below = origin;
    precise vec3 inv_dir = vec3(1.0) / dir;
    ray.inv_dir = inv_dir;
    ray.negative = lessThan(inv_dir, vec3(0.0));
    vec3 size = abs(dir);
    bool x_over_y = size.x > size.y;
    bool x_over_z = size.x > size.z;
    bool y_over_z = size.y > size.z;
    ray.space = bvec2(false);
    ray.dominant = bvec2(x_over_y && x_over_z, !x_over_y && y_over_z);
    vec3 turned = turn_dominant(ray.dominant, dir);
    precise vec3 shear;
    shear.z = 1.0 / turned.z;
    shear.x = turned.x / turned.z;
    shear.y = turned.y / turned.z;
    // Vulkan bounds the error of quotients (2.5 ulp) only for divisors in 2^-126..2^126. For others
    // the shear is NaN, with which no filter decides. The reciprocal of a denormal may be infinite, as
    // if the ray did not move on that axis; NaN bounds nothing there.
    if (SPEC_NUMERICS == NUMERICS_EXACT) {
        const float nan = uintBitsToFloat(0x7fc00000u);
        float length = abs(turned.z);
        if (!(length > 7.8886090522101181e-31 && length < 1.2676506002282294e+30))
            shear = vec3(nan);
        uvec3 bits = floatBitsToUint(dir) & 0x7fffffffu;
        ray.inv_dir = mix(inv_dir, vec3(nan), lessThan(bits - 1u, uvec3(0x7fffffu)));
    }
    ray.shear = shear;
    return ray;
}

// The margin of boxes in trees whose leaves hold clipped triangles. There a hit may lie outside the
// boxes above it, by the roundings of the clip and of the triangle test. Both are relative to
// distances from the ray's origin, none of which exceeds that to the centre of the mesh's box plus
// its `reach`.
const float CLIP_MARGIN = 1.0 / 524288.0;

void widen_boxes(inout RaySetup ray, vec3 margin)
{
    precise vec3 above = ray.origin + margin;
    precise vec3 below = ray.origin - margin;
    ray.above = above;
    ray.below = below;
}

void widen_ray_setup(inout RaySetup ray, vec3 center, float reach)
{
    precise vec3 away = abs(ray.origin - center);
    float farthest = away.x > away.y ? away.x : away.y;
    farthest = away.z > farthest ? away.z : farthest;
    precise float margin = (farthest + reach) * CLIP_MARGIN;
    widen_boxes(ray, vec3(margin));
}

// The margin of boxes in the tree over instances, whose rays are transformed below: the transform
// of the origin and of the direction is rounded relative to the distance from the instance. `own`,
// `others`: shares of the origin's coordinate on an axis, and of its largest one (fetch_slack).
void widen_world_setup(inout RaySetup ray, vec3 own, vec3 others)
{
    vec3 size = abs(ray.origin);
    float farthest = size.x > size.y ? size.x : size.y;
    farthest = size.z > farthest ? size.z : farthest;
    precise vec3 margin = size * own + farthest * others;
    widen_boxes(ray, margin);
}

// Widens the far end of a slab interval, by more than the error of (b - o) * (1 / d) on both ends
// (Ize 2013 shows that 2 ulp close all holes between boxes) and more than the error of the edge
// functions, by which a triangle may be hit by a ray that passes its box within rounding.
const float SLAB_FAR_SCALE = 1.0 + 1.0 / 1048576.0;

// The part of the ray inside a box. `first` and `last` are the box's corners that the ray reaches
// first and last, relative to its origin. NaN (0 times infinity: the origin in the plane of a face,
// the ray parallel to it) loses every comparison and so bounds nothing.
void slab_between(RaySetup ray, vec3 first, vec3 last, float t_min, out float t_near, out float t_far)
{
    precise vec3 near = first * ray.inv_dir;
    precise vec3 far = last * ray.inv_dir;
    float start = t_min;
    start = near.x > start ? near.x : start;
    start = near.y > start ? near.y : start;
    start = near.z > start ? near.z : start;
    float end = uintBitsToFloat(0x7f800000u);
    end = far.x < end ? far.x : end;
    end = far.y < end ? far.y : end;
    end = far.z < end ? far.z : end;
    precise float widened = end * SLAB_FAR_SCALE;
    t_near = start;
    t_far = SPEC_NUMERICS == NUMERICS_FAST ? end : widened;
}

void slab_interval(RaySetup ray, vec3 lo, vec3 hi, float t_min, out float t_near, out float t_far)
{
    slab_between(ray, mix(lo, hi, ray.negative), mix(hi, lo, ray.negative), t_min, t_near, t_far);
}

// Shears the vertices, whose dominant axis is last, so that the ray goes along that axis. Also the
// edge function opposite each vertex.
void shear_triangle(RaySetup ray, vec3 ta, vec3 tb, vec3 tc, out vec2 sa, out vec2 sb, out vec2 sc,
                    out vec3 edges)
{
    precise vec2 a = ta.xy - ray.shear.xy * ta.z;
    precise vec2 b = tb.xy - ray.shear.xy * tb.z;
    precise vec2 c = tc.xy - ray.shear.xy * tc.z;
    precise float ea = c.x * b.y - c.y * b.x;
    precise float eb = a.x * c.y - a.y * c.x;
    precise float ec = b.x * a.y - b.y * a.x;
    sa = a;
    sb = b;
    sc = c;
    edges = vec3(ea, eb, ec);
}

// The point where the ray meets the triangle, by its edge functions.
struct Weights {
    float det, inv_det;
    float t, b, c; // distance along the ray; weights of the second and the third vertex
    vec3 z;        // distances of the vertices, along the ray
};

// `az`, `bz`, `cz`: coordinates of the vertices along the dominant axis, relative to the origin of the ray.
Weights weigh_triangle(RaySetup ray, float az, float bz, float cz, vec3 edges)
{
    precise vec3 z = ray.shear.z * vec3(az, bz, cz);
    precise float det = (edges.x + edges.y) + edges.z;
    precise float inv_det = 1.0 / det;
    // Weights are computed first: edge functions are areas, and areas times lengths overflow for
    // lengths from 2^42 on.
    precise float weight_a = edges.x * inv_det;
    precise float weight_b = edges.y * inv_det;
    precise float weight_c = edges.z * inv_det;
    precise float at = (weight_a * z.x + weight_b * z.y) + weight_c * z.z;
    return Weights(det, inv_det, at, weight_b, weight_c, z);
}

// Bounds of three points.
void bound_points(vec3 a, vec3 b, vec3 c, out vec3 lo, out vec3 hi)
{
    lo.x = a.x < b.x ? a.x : b.x;
    lo.y = a.y < b.y ? a.y : b.y;
    lo.z = a.z < b.z ? a.z : b.z;
    hi.x = a.x > b.x ? a.x : b.x;
    hi.y = a.y > b.y ? a.y : b.y;
    hi.z = a.z > b.z ? a.z : b.z;
    lo.x = c.x < lo.x ? c.x : lo.x;
    lo.y = c.y < lo.y ? c.y : lo.y;
    lo.z = c.z < lo.z ? c.z : lo.z;
    hi.x = c.x > hi.x ? c.x : hi.x;
    hi.y = c.y > hi.y ? c.y : hi.y;
    hi.z = c.z > hi.z ? c.z : hi.z;
}

// Watertight ray/triangle test (Woop, Benthin and Wald 2013) on vertices relative to the origin. An
// edge function of exactly 0 counts as inside for both neighbours; the tie rule then picks one. The
// ray must also meet the triangle's own box, and t may not lie before it: with boxes that contain
// each other exactly, no tree, order or builder can then lose or gain a hit (docs/numerics.md).
// `first`, `last`: corners of that box, see slab_between. `front`: hit from the side that sees the
// vertices counter-clockwise.
bool intersect_triangle(RaySetup ray, vec3 a, vec3 b, vec3 c, vec3 first, vec3 last, float t_min,
                        out float t, out float u, out float v, out bool front)
{
    float t_near, t_far;
    slab_between(ray, first, last, t_min, t_near, t_far);

    vec3 ta = turn_dominant(ray.dominant, a);
    vec3 tb = turn_dominant(ray.dominant, b);
    vec3 tc = turn_dominant(ray.dominant, c);
    vec2 sa, sb, sc;
    vec3 edges;
    shear_triangle(ray, ta, tb, tc, sa, sb, sc, edges);
    bool below = edges.x < 0.0 || edges.y < 0.0 || edges.z < 0.0;
    bool above = edges.x > 0.0 || edges.y > 0.0 || edges.z > 0.0;
    Weights w = weigh_triangle(ray, ta.z, tb.z, tc.z, edges);
    u = w.b;
    v = w.c;
    t = w.t > t_near ? w.t : t_near;
    front = (w.det > 0.0) == (ray.shear.z > 0.0);
    // w.t >= t_min is false for NaN: overflow and zero area give no hit.
    return !(below && above) && w.det != 0.0 && w.t >= t_min && t_near <= t_far;
}

// Whether a point on this edge, as seen along the ray, belongs to the triangle on its left.
bool owns_edge(vec2 edge, bool left)
{
    return left ? edge.y > 0.0 || (edge.y == 0.0 && edge.x > 0.0)
                : edge.y < 0.0 || (edge.y == 0.0 && edge.x < 0.0);
}

// Whether the triangle owns the point where it is hit. `on_edge`: which edge functions are 0;
// `left`: the side of its edges on which the triangle lies.
bool owns_its_edges(vec2 sa, vec2 sb, vec2 sc, bvec3 on_edge, bool left)
{
    return (!on_edge.x || owns_edge(sc - sb, left)) && (!on_edge.y || owns_edge(sa - sc, left)) &&
           (!on_edge.z || owns_edge(sb - sa, left));
}

// Whether this triangle owns the point where the ray hits it. Of the triangles around an edge or a
// vertex that a ray hits exactly, seen from the same side, just one does: the fill rule of
// rasterizers (Pineda 1988). For what must be counted once.
bool owns_point(RaySetup ray, vec3 a, vec3 b, vec3 c)
{
    vec2 sa, sb, sc;
    vec3 edges;
    shear_triangle(ray, turn_dominant(ray.dominant, a), turn_dominant(ray.dominant, b),
                   turn_dominant(ray.dominant, c), sa, sb, sc, edges);
    precise float det = (edges.x + edges.y) + edges.z;
    return owns_its_edges(sa, sb, sc, equal(edges, vec3(0.0)), det > 0.0);
}

#endif

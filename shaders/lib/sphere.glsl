// Tests of spheres against a ray, and points on spheres. Every product and sum is `precise`,
// rounded once: twin/sphere.h is this file in C, and gives the same bits (docs/numerics.md).
#ifndef LIB_SPHERE_GLSL
#define LIB_SPHERE_GLSL

#include "angles.glsl"
#include "intersect.glsl"

// NUMERICS_EXACT: what floats can decide. Keys are the exact t of the ends of the chord, rounded to
// nearest.
struct SphereBounds {
    bool outside;      // surely missed
    bool inside;       // surely hit, and the chord's values are valid
    bool inward_known; // the chord's `inward` is certain
    float near_lo, near_hi, far_lo, far_hi; // bounds of the keys, if it is hit
};

// The chord of a ray's line in a sphere.
struct Chord {
    SphereBounds bounds;  // NUMERICS_EXACT
    bool met;             // the line meets the sphere, the ray its box; NUMERICS_EXACT: may meet it
    bool inward;          // the ray first approaches the centre
    float t_near, t_far;  // where the line enters and leaves the sphere, not before t_box
    float t_box;          // where the ray enters the sphere's box, or t_min
    vec3 middle, to_exit; // vectors: from the centre to the chord's middle; from there to its far
                          // end
};

// The box of a sphere, widened by more than rounding takes from it: by four roundings of `|center|
// + radius`, where c +- r carries one. Trees are built over this very box.
void sphere_box(vec3 center, float radius, out vec3 lo, out vec3 hi)
{
    precise vec3 margin = (abs(center) + radius) * (1.0 / 4194304.0);
    precise vec3 below = (center - radius) - margin;
    precise vec3 above = (center + radius) + margin;
    lo = below;
    hi = above;
}

// The perpendicular from a sphere's centre to the ray's line, with the dominant axis last, in units
// in which the direction is (shear.x, shear.y, 1): so no direction is too long or too short to be
// squared.
struct Foot {
    vec3 c, d;         // centre relative to the ray's origin; direction
    float dd, mid;     // d.d; place of the foot on the line, in units of d
    vec3 off;          // from the foot to the centre
    float rr, room;    // radius squared; radius squared less the squared distance of the line
    float half_length; // of the chord, in units of d
};

Foot drop_perpendicular(RaySetup ray, vec3 center, float radius)
{
    precise vec3 relative = center - ray.origin;
    vec3 c = turn_dominant(ray.dominant, relative);
    vec3 d = vec3(ray.shear.x, ray.shear.y, 1.0);
    precise float dd = (d.x * d.x + d.y * d.y) + 1.0;
    precise float cd = (c.x * d.x + c.y * d.y) + c.z;
    precise float mid = cd / dd;
    precise vec3 off = c - d * mid;
    precise float rr = radius * radius;
    precise float room = rr - ((off.x * off.x + off.y * off.y) + off.z * off.z);
    precise float part = (room > 0.0 ? room : 0.0) / dd;
    precise float half_length = sqrt(part);
    return Foot(c, d, dd, mid, off, rr, room, half_length);
}

// Haines, Günther and Akenine-Möller 2019, "Precision improvements for ray/sphere intersection"
// (Ray Tracing Gems, chapter 7): the discriminant comes from the perpendicular dropped on the ray,
// not from a difference of squared distances; the end of the chord that is farther from the origin
// comes from the sum, the nearer one from the product of both. The ray must also meet the sphere's
// own box, and t may not lie before it, as with triangles.
Chord intersect_sphere(RaySetup ray, vec3 center, float radius, float t_min)
{
    Chord chord;
    vec3 lo, hi;
    sphere_box(center, radius, lo, hi);
    precise vec3 box_lo = lo - ray.origin;
    precise vec3 box_hi = hi - ray.origin;
    float box_near, box_far;
    slab_interval(ray, box_lo, box_hi, t_min, box_near, box_far);

    Foot foot = drop_perpendicular(ray, center, radius);
    vec3 c = foot.c;
    float mid = foot.mid;
    precise float farther = mid < 0.0 ? mid - foot.half_length : mid + foot.half_length;
    precise float product = ((c.x * c.x + c.y * c.y) + c.z * c.z) - foot.rr;
    precise float nearer = product / (foot.dd * farther);
    bool down = ray.shear.z < 0.0;
    bool ends_nearer = (mid < 0.0) != down;
    precise float t_near = (ends_nearer ? farther : nearer) * ray.shear.z;
    precise float t_far = (ends_nearer ? nearer : farther) * ray.shear.z;
    chord.t_box = box_near;
    chord.t_near = t_near;
    chord.t_far = t_far;
    chord.met = foot.room >= 0.0 && box_near <= box_far;
    chord.inward = mid != 0.0 && (mid < 0.0) == down;
    float forward = down ? -foot.half_length : foot.half_length;
    precise vec3 to_exit = foot.d * forward;
    chord.middle = -foot.off;
    chord.to_exit = to_exit;
    return chord;
}

// Undoes turn_dominant.
vec3 turn_back(bvec2 dominant, vec3 p)
{
    return dominant.x ? p.zxy : dominant.y ? p.yzx : p;
}

// The vector from the centre to the chord's far or near end: its length is the radius within
// rounding, however far away the ray's origin is.
vec3 chord_end(RaySetup ray, Chord chord, bool at_exit)
{
    precise vec3 begin = chord.middle - chord.to_exit;
    precise vec3 end = chord.middle + chord.to_exit;
    return turn_back(ray.space, turn_back(ray.dominant, at_exit ? end : begin));
}

// Maps a direction to the unit square (Meyer et al. 2010); +y is in the middle, and so is a vector
// without length.
vec2 square_from_dir(vec3 dir)
{
    precise float size = (abs(dir.x) + abs(dir.y)) + abs(dir.z);
    precise vec2 p = dir.xz / size;
    precise vec2 folded = vec2(1.0) - abs(p.yx);
    folded.x = p.x >= 0.0 ? folded.x : -folded.x;
    folded.y = p.y >= 0.0 ? folded.y : -folded.y;
    precise vec2 at = (dir.y < 0.0 ? folded : p) * 0.5 + 0.5;
    return size > 0.0 ? at : vec2(0.5);
}

// Undoes square_from_dir. The result is not of unit length: |x| + |y| + |z| is 1.
vec3 dir_from_square(vec2 at)
{
    precise vec2 p = at * 2.0 - 1.0;
    precise float y = (1.0 - abs(p.x)) - abs(p.y);
    precise vec2 folded = vec2(1.0) - abs(p.yx);
    folded.x = p.x >= 0.0 ? folded.x : -folded.x;
    folded.y = p.y >= 0.0 ? folded.y : -folded.y;
    vec2 xz = y < 0.0 ? folded : p;
    return vec3(xz.x, y, xz.y);
}

// Texture coordinates of a sphere, 0..1: u goes once around y from +x towards -z, v from the top
// (+y) down.
vec2 sphere_uv(vec3 dir)
{
    const float pi = 3.14159265;
    float around = angle_of(dir.x, -dir.z) * (0.5 / pi);
    float down = angle_of(dir.y, sqrt(dir.x * dir.x + dir.z * dir.z)) * (1.0 / pi);
    return vec2(around < 0.0 ? around + 1.0 : around, down);
}

#endif

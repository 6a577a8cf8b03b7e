// Tests one record against a ray: where the ray hits the record's triangle or sphere.
// twin/traverse.c is this in C.
#ifndef BIND_PRIMITIVE_GLSL
#define BIND_PRIMITIVE_GLSL

#include "../lib/exact.glsl"
#include "../lib/ff_triangle.glsl"
#include "../lib/ff_sphere.glsl"
#include "../lib/intersect.glsl"
#include "../lib/moller.glsl"
#include "trees.glsl"

// Modes of traversal: what it looks for. Always a constant, so that each use is compiled for its
// own mode.
const uint TRAVERSE_CLOSEST = 0u;
const uint TRAVERSE_ANY = 1u;    // any hit will do
const uint TRAVERSE_SHADOW = 2u; // any opaque hit will do; depths of filters add up
// The closest hit behind a known one, in the order of (t, instance, primitive). The known hit is
// given in hit_before, skip_instance and skip_primitive, with t_min as it was; at NUMERICS_EXACT
// hit_before_at_exit tells whether it was the far end of a sphere.
const uint TRAVERSE_NEXT = 3u;
float hit_before;
bool hit_before_at_exit;

bool finds_closest(const uint mode)
{
    return mode == TRAVERSE_CLOSEST || mode == TRAVERSE_NEXT;
}

const float FLOAT_LARGEST = 3.402823466e+38;

struct Hit {
    float t; // the largest t that counts until there is a hit, then its t
    float lo, hi; // NUMERICS_EXACT: bounds of the hit's key, see lib/exact.glsl
    float u, v;     // of a sphere: square_from_dir of the normal, object space
    bool at_exit;   // NUMERICS_EXACT: the far end of a sphere
    uint triangle;  // number of its record
    bool glass;     // light passes through it
    uint primitive; // index in its mesh, or HIT_NONE
    uint instance;
    ivec3 filter_depth; // TRAVERSE_SHADOW: sum over the filters met
    float filter_end;   // the t from which their absorption is measured
    uint status;
};

Hit make_hit(float t_max)
{
    Hit hit;
    hit.t = t_max < FLOAT_LARGEST ? t_max : FLOAT_LARGEST;
    hit.lo = hit.t;
    hit.hi = hit.t;
    hit.u = 0.0;
    hit.v = 0.0;
    hit.at_exit = false;
    hit.triangle = 0u;
    hit.glass = false;
    hit.primitive = HIT_NONE;
    hit.instance = HIT_NONE;
    hit.filter_depth = ivec3(0);
    hit.filter_end = 0.0;
    hit.status = 0u;
    return hit;
}

// A triangle or a sphere, from its record.
struct Primitive {
    uvec4 r0, r1, r2;
    uint index, flags, instance;
    bool self; // the ray starts on it
    bool known; // NUMERICS_EXACT: a sphere, one of whose ends is the known hit
    bool is_sphere;
};

struct RecordRows {
    uvec4 r0, r1, r2;
};

bool has_third_row()
{
    return SPEC_SPHERES != SPHERES_ONLY || SPEC_FILTERS != 0u;
}

RecordRows fetch_record(uint record)
{
    RecordRows rows;
    rows.r0 = fetch_triangle_row(record * TRIANGLE_ROWS);
    rows.r1 = fetch_triangle_row(record * TRIANGLE_ROWS + 1u);
    rows.r2 = uvec4(0u);
    if (has_third_row())
        rows.r2 = fetch_triangle_row(record * TRIANGLE_ROWS + 2u);
    return rows;
}

// With SPEC_FLAT the instance is taken from the record.
Primitive make_primitive(const uint mode, RecordRows rows, uint instance, uint skip_instance,
                         uint skip_primitive)
{
    Primitive p;
    p.r0 = rows.r0;
    p.r1 = rows.r1;
    p.r2 = rows.r2;
    p.index = p.r0.w;
    p.flags = p.r1.w;
    p.instance = SPEC_FLAT != 0u ? p.flags >> TRIANGLE_INSTANCE_SHIFT : instance;
    p.is_sphere = SPEC_SPHERES != SPHERES_NONE && (p.flags & TRIANGLE_SPHERE) != 0u;
    bool skipped = p.index == skip_primitive;
    // Packets enter an instance that some of their rays skip. Rays alone do not.
    if (SPEC_INSTANCED != 0u && SPEC_PACKETS != 0u)
        skipped = skipped || skip_primitive == SKIP_ALL;
    p.self = skipped && p.instance == skip_instance;
    p.known = SPEC_NUMERICS == NUMERICS_EXACT && mode == TRAVERSE_NEXT && p.self && p.is_sphere;
    if (mode == TRAVERSE_NEXT) // a triangle has no second hit; a sphere has
        p.self = p.self && !p.is_sphere;
    return p;
}

// A candidate hit: where a ray meets a primitive.
struct Candidate {
    bool met;
    float t, u, v;
    bool front; // met from outside
    bool owned; // one of several triangles that share the point owns it
    // NUMERICS_EXACT: bounds of the key. Unless `sure`, it is open whether the primitive is hit,
    // and settle() decides; until then t, u and v are valid where `rounded`.
    float lo, hi;
    bool sure, rounded;
};

Candidate bound_triangle(RaySetup ray, float t_min, vec3 a, vec3 b, vec3 c)
{
    ExactBounds bounds = exact_filter(ray, a, b, c);
    Candidate m;
    m.met = !bounds.outside && !(bounds.hi < t_min);
    m.t = has_bounds_alone() || bounds.t > t_min ? bounds.t : t_min; // floats are sure of t >= t_min
    m.u = bounds.u;
    m.v = bounds.v;
    m.front = !bounds.inside || bounds.front;
    m.owned = true;
    m.lo = bounds.lo;
    m.hi = bounds.hi;
    m.sure = bounds.inside && bounds.lo >= t_min;
    m.rounded = bounds.inside;
    return m;
}

Candidate meet_triangle(RaySetup ray, float t_min, uvec4 r0, uvec4 r1, uvec4 r2)
{
    Candidate m;
    if (SPEC_NUMERICS == NUMERICS_FAST) {
        m.met = intersect_moller(ray.origin, ray.dir, row_vec3(r0), row_vec3(r1), row_vec3(r2),
                                 t_min, m.t, m.u, m.v, m.front);
        if (SPEC_FLAT != 0u)
            m.front = m.front == ((r1.w & TRIANGLE_MIRRORED) == 0u);
        m.owned = true;
        return m;
    }
    vec3 v0 = turn_dominant(ray.space, row_vec3(r0)), v1 = turn_dominant(ray.space, row_vec3(r1));
    vec3 v2 = turn_dominant(ray.space, row_vec3(r2));
    precise vec3 a = v0 - ray.origin;
    precise vec3 b = v1 - ray.origin;
    precise vec3 c = v2 - ray.origin;
    if (SPEC_NUMERICS == NUMERICS_EXACT) {
        m = bound_triangle(ray, t_min, a, b, c);
        if (SPEC_FLAT != 0u)
            m.front = !m.rounded || m.front == ((r1.w & TRIANGLE_MIRRORED) == 0u);
        return m;
    }
    vec3 lo, hi;
    if (SPEC_PACKET_RAYS > 1u) // these are shared by all rays of a packet with the same signs
        bound_points(v0, v1, v2, lo, hi);
    else
        bound_points(a, b, c, lo, hi);
    precise vec3 first = mix(lo, hi, ray.negative);
    precise vec3 last = mix(hi, lo, ray.negative);
    if (SPEC_PACKET_RAYS > 1u) {
        first -= ray.origin;
        last -= ray.origin;
    }
    m.met = intersect_triangle(ray, a, b, c, first, last, t_min, m.t, m.u, m.v, m.front);
    if (SPEC_FLAT != 0u)
        m.front = m.front == ((r1.w & TRIANGLE_MIRRORED) == 0u);
    m.owned = owns_point(ray, a, b, c);
    return m;
}

// Sets what float arithmetic knows of a candidate hit at one end of a chord. Where it leaves open
// whether the near end is before t_min, the hit may be at the far end.
void bound_end(SphereBounds bounds, bool inward, float t_min, bool at_exit, bool self,
               inout Candidate m)
{
    bool known = at_exit || bounds.near_lo >= t_min;
    m.lo = at_exit ? bounds.far_lo : bounds.near_lo;
    m.hi = at_exit || !known ? bounds.far_hi : bounds.near_hi;
    m.met = !bounds.outside && !(m.hi < t_min) && (!self || inward || !bounds.inward_known);
    m.rounded = bounds.inside && known;
    m.sure = m.rounded && m.lo >= t_min && (!self || bounds.inward_known);
}

// The candidate hit at one end of a chord. A ray that starts on the sphere (`self`) can only meet the far
// end, and only if it goes inwards. No small distance has to be chosen for that.
Candidate meet_sphere(RaySetup ray, Chord chord, float t_min, bool at_exit, bool self)
{
    Candidate m;
    float at = at_exit ? chord.t_far : chord.t_near;
    // False for NaN.
    m.met = chord.met && at >= t_min && (!self || chord.inward);
    m.t = at > chord.t_box ? at : chord.t_box;
    vec2 square = square_from_dir(chord_end(ray, chord, at_exit));
    m.u = square.x;
    m.v = square.y;
    m.front = !at_exit;
    m.owned = true;
    if (SPEC_NUMERICS == NUMERICS_EXACT)
        bound_end(chord.bounds, chord.inward, t_min, at_exit, self, m);
    return m;
}

// The candidate hit of a primitive; of a sphere at the far end of the chord if `at_exit`, else the near one.
Candidate meet_primitive(RaySetup ray, float t_min, Primitive p, Chord chord, bool at_exit)
{
    Candidate m;
    if (SPEC_SPHERES != SPHERES_ONLY) {
        m = meet_triangle(ray, t_min, p.r0, p.r1, p.r2);
        m.met = m.met && !p.self;
    }
    if (SPEC_SPHERES != SPHERES_NONE) {
        Candidate on_sphere = meet_sphere(ray, chord, t_min, at_exit, p.self);
        on_sphere.met = on_sphere.met && !(p.known && hit_before_at_exit);
        if (SPEC_SPHERES == SPHERES_ONLY)
            m = on_sphere;
        m.met = p.is_sphere ? on_sphere.met : m.met;
        m.t = p.is_sphere ? on_sphere.t : m.t;
        m.u = p.is_sphere ? on_sphere.u : m.u;
        m.v = p.is_sphere ? on_sphere.v : m.v;
        m.front = p.is_sphere ? on_sphere.front : m.front;
        m.owned = p.is_sphere || m.owned;
        m.lo = p.is_sphere ? on_sphere.lo : m.lo;
        m.hi = p.is_sphere ? on_sphere.hi : m.hi;
        m.sure = p.is_sphere ? on_sphere.sure : m.sure;
        m.rounded = p.is_sphere ? on_sphere.rounded : m.rounded;
    }
    return m;
}

Chord chord_of(RaySetup ray, float t_min, Primitive p)
{
    Chord chord;
    vec3 center = turn_dominant(ray.space, row_vec3(p.r0));
    if (SPEC_SPHERES != SPHERES_NONE)
        chord = intersect_sphere(ray, center, uintBitsToFloat(p.r1.x), t_min);
    if (SPEC_SPHERES != SPHERES_NONE && SPEC_NUMERICS == NUMERICS_EXACT) {
        chord.bounds = bound_sphere(ray, center, uintBitsToFloat(p.r1.x));
        chord.met = !chord.bounds.outside;
    }
    return chord;
}

// Whether the near end of the chord cannot be hit, since it is before t_min or the ray starts on
// the sphere.
bool starts_at_exit(const uint mode, Primitive p, Chord chord, float t_min)
{
    bool before = !(chord.t_near >= t_min);
    if (SPEC_NUMERICS == NUMERICS_EXACT)
        before = chord.bounds.near_hi < t_min ||
                 (mode == TRAVERSE_NEXT && (p.known || chord.bounds.near_hi < hit_before));
    return SPEC_SPHERES != SPHERES_NONE && (p.self || before);
}

#endif

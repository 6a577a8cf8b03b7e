// NUMERICS_EXACT: decides by integer arithmetic (lib/exact.glsl) what floats leave undecided about
// a record. twin/traverse.c is this in C.
#ifndef BIND_SETTLE_GLSL
#define BIND_SETTLE_GLSL

#include "primitive.glsl"

// The exact hit of a record's triangle. `hit`: it is known that it is hit, and only the key is
// wanted. Without SPEC_SETTLES there is no integer arithmetic: a ray that float-float leaves
// undecided is deferred.
ExactCandidate meet_record_triangle(vec3 origin, vec3 dir, uint record, bool hit, inout uint status)
{
    vec3 v0 = row_vec3(fetch_triangle_row(record * TRIANGLE_ROWS));
    vec3 v1 = row_vec3(fetch_triangle_row(record * TRIANGLE_ROWS + 1u));
    vec3 v2 = row_vec3(fetch_triangle_row(record * TRIANGLE_ROWS + 2u));
    ExactCandidate m;
    bool key_known, finished = true;
    bool known = ff_meet(origin, dir, v0, v1, v2, m, key_known);
    known = hit ? key_known : known;
    if (SPEC_SETTLES == 0u && !known)
        status |= STATUS_RAY_DEFERRED;
    if (SPEC_SETTLES != 0u && !known)
        m = exact_meet(origin, dir, v0, v1, v2, finished);
    if (!finished)
        status |= STATUS_UNFINISHED_TRAVERSAL;
    return m;
}

// The ends of a sphere's chord that count: those from t_min on; `only_far`: only the far one;
// `self`: the ray starts on the sphere, and hits an end only if it goes inwards.
struct Ends {
    float t_min;
    bool only_far, self;
};

// The exact hit of a record's sphere; a ray may be deferred as in meet_record_triangle.
ExactCandidate meet_record_sphere(vec3 origin, vec3 dir, uint record, Ends ends, inout uint status)
{
    uvec4 r1 = fetch_triangle_row(record * TRIANGLE_ROWS + 1u);
    vec3 center = row_vec3(fetch_triangle_row(record * TRIANGLE_ROWS));
    float radius = uintBitsToFloat(r1.x);
    SphereCandidate on_sphere;
    bool finished = true;
    bool known = ff_meet_sphere(origin, dir, center, radius, ends.only_far, ends.t_min,
                                  on_sphere);
    if (SPEC_SETTLES == 0u && !known)
        status |= STATUS_RAY_DEFERRED;
    if (SPEC_SETTLES != 0u && !known)
        on_sphere = exact_meet_sphere(origin, dir, center, radius, ends.only_far, ends.t_min,
                                      finished);
    if (!finished)
        status |= STATUS_UNFINISHED_TRAVERSAL;
    precise vec3 to_center = center - origin;
    precise vec3 from_center = dir * on_sphere.key - to_center;
    vec2 square = square_from_dir(from_center);
    ExactCandidate m;
    m.met = on_sphere.met && (!ends.self || on_sphere.inward);
    m.front = !on_sphere.at_exit;
    m.key = on_sphere.key;
    m.u = square.x;
    m.v = square.y;
    m.on_edge = bvec3(false);
    return m;
}

ExactCandidate meet_record(vec3 origin, vec3 dir, uint record, bool hit, Ends ends,
                         inout uint status)
{
    ExactCandidate m;
    bool sphere = SPEC_SPHERES == SPHERES_ONLY;
    if (SPEC_SPHERES == SPHERES_SOME)
        sphere = (fetch_triangle_row(record * TRIANGLE_ROWS + 1u).w & TRIANGLE_SPHERE) != 0u;
    if (SPEC_SPHERES != SPHERES_ONLY && !sphere)
        m = meet_record_triangle(origin, dir, record, hit, status);
    if (SPEC_SPHERES != SPHERES_NONE && sphere)
        m = meet_record_sphere(origin, dir, record, ends, status);
    return m;
}

// Replaces the bounds of a candidate by the exact result.
void settle_candidate(float t_min, ExactCandidate exact, inout Candidate m)
{
    m.met = m.met && exact.met && exact.key >= t_min;
    m.front = exact.front;
    m.t = m.rounded ? m.t : exact.key;
    m.u = m.rounded ? m.u : exact.u;
    m.v = m.rounded ? m.v : exact.v;
    m.lo = exact.key;
    m.hi = exact.key;
}

// Sets the fields of a hit triangle that shading and filters also need: `owned`, and in a flat tree
// `front`.
void settle_sides(RaySetup ray, Primitive p, ExactCandidate exact, inout Candidate m)
{
    precise vec3 a = row_vec3(p.r0) - ray.origin;
    precise vec3 b = row_vec3(p.r1) - ray.origin;
    precise vec3 c = row_vec3(p.r2) - ray.origin;
    vec2 sa, sb, sc;
    vec3 edges;
    shear_triangle(ray, turn_dominant(ray.dominant, a), turn_dominant(ray.dominant, b),
                   turn_dominant(ray.dominant, c), sa, sb, sc, edges);
    m.owned = owns_its_edges(sa, sb, sc, exact.on_edge, exact.front == (ray.shear.z > 0.0));
    if (SPEC_FLAT != 0u)
        m.front = m.front == ((p.flags & TRIANGLE_MIRRORED) == 0u);
}

// Transforms a ray to the object space of an instance.
void take_to_instance(uint instance, inout vec3 origin, inout vec3 dir)
{
    if (SPEC_INSTANCED != 0u) {
        InstanceFrame frame = fetch_instance_frame(instance);
        origin = to_object_point(frame, origin);
        dir = to_object_dir(frame, dir);
    }
}

// NUMERICS_EXACT: computes the key of a candidate hit, and also that of the hit so far where only
// both tell which comes first. `origin`, `dir`: the ray in world space. `at_exit`: in and out,
// whether the candidate is the far end of a sphere.
void settle(RaySetup ray, vec3 origin, vec3 dir, float t_min, uint record, Primitive p,
            inout bool at_exit, inout Candidate m, inout Hit hit)
{
    vec3 from = ray.origin, along = ray.dir;
    Ends ends = Ends(t_min, at_exit, p.self);
    bool first = true, again;
    do {
        ExactCandidate exact = meet_record(from, along, record, !first, ends, hit.status);
        again = false;
        if (first) {
            m.rounded = m.rounded && (!p.is_sphere || exact.front != at_exit);
            settle_candidate(t_min, exact, m);
            at_exit = p.is_sphere && !exact.front;
            if (!p.is_sphere)
                settle_sides(ray, p, exact, m);
            again = m.met && hit.lo < hit.hi && hit.lo <= m.lo && m.lo <= hit.hi;
            from = origin;
            along = dir;
            take_to_instance(again ? hit.instance : 0u, from, along);
            record = hit.triangle;
            ends = Ends(0.0, hit.at_exit, false);
        } else {
            hit.lo = exact.key;
            hit.hi = exact.key;
        }
        first = false;
    } while (another_iteration(again));
    if (again) // the driver has cut the loop short
        hit.status |= STATUS_UNFINISHED_TRAVERSAL;
}

// NUMERICS_EXACT: sets the t of a hit to its key, which it computes where it is not known yet.
// Shading does without it: it needs less, and would pay for it on every ray.
void finish_hit(vec3 origin, vec3 dir, inout Hit hit)
{
    bool loose = hit.lo < hit.hi;
    if (!loose)
        hit.t = hit.lo;
    take_to_instance(loose ? hit.instance : 0u, origin, dir);
    if (loose) {
        Ends ends = Ends(0.0, hit.at_exit, false);
        hit.t = meet_record(origin, dir, hit.triangle, true, ends, hit.status).key;
    }
    hit.lo = hit.t;
    hit.hi = hit.t;
}

#endif

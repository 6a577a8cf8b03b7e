// The media on both sides of a surface that a ray crosses: nested dielectrics, and surfaces of two
// media that touch.
#ifndef BIND_CROSSING_GLSL
#define BIND_CROSSING_GLSL

#include "media.glsl"
#include "ray.glsl"
#include "surface.glsl"

// The most surfaces that are crossed at one place.
const uint CROSSED_MAX = 4u;

struct Crossing {
    uvec4 before, after; // media on both sides, see MEDIA_MAX
    float eta;           // index of refraction of the ray's side over that of the other
    bool seen;           // false: both sides are the same medium, so there is nothing to see
    // Where light that passes goes on: at the last of the surfaces that are crossed here.
    vec3 p, error, ng;
    uint instance, record;
    bool outwards; // it is left there, not entered
};

float largest_of(vec3 v)
{
    return max(v.x, max(v.y, v.z));
}

// How far apart along the ray two hits of one place may be. Each t of the intersection test is off
// by a few roundings of the coordinates that enter it, across the surface. Along the ray this is
// divided by the cosine, which is bounded, so that rays along a surface do not gather all that is
// near it.
float crossing_slack(Surface s, Ray ray, float t)
{
    float size = largest_of(abs(ray.origin)) + largest_of(abs(s.p)) + largest_of(abs(s.e1)) +
                 largest_of(abs(s.e2)) + t;
    return rounding_bound(8.0) * size / max(abs(dot(ray.dir, s.ng)), 1.0 / 1024.0);
}

// frame.contact, a distance across the surface, measured along the ray.
float crossing_contact(Surface s, Ray ray)
{
    return frame.contact / max(abs(dot(ray.dir, s.ng)), 1.0 / 16.0);
}

// The surfaces that are crossed at one place, in the order of the ray.
struct Crossed {
    uvec4 entries; // material + 1
    uvec4 instances;
    uint leaving;  // bit i: medium i is left, not entered
    uint count;
};

// Index of the last crossed surface of the same body; CROSSED_MAX: there is none.
uint find_crossed(Crossed crossed, uint entry, uint instance)
{
    uint found = CROSSED_MAX;
    for (uint i = 0u; i < CROSSED_MAX; i++)
        found = i < crossed.count && crossed.entries[i] == entry &&
                        crossed.instances[i] == instance
                    ? i
                    : found;
    return found;
}

// Enters all media that are entered, then leaves those that are left, since rounding may swap
// surfaces that touch. A medium that is left without having been entered (an open mesh) was around
// the ray so far.
void cross_all(Crossed crossed, inout Crossing c, inout uint status)
{
    uint i = 0u;
    do {
        uint entry = crossed.entries[i & 3u];
        if (i < crossed.count && (crossed.leaving >> i & 1u) == 0u)
            c.after = media_with(c.after, entry, status);
        i++;
    } while (i < crossed.count);
    i = 0u;
    do {
        uint entry = crossed.entries[i & 3u];
        if (i < crossed.count && (crossed.leaving >> i & 1u) != 0u) {
            if (media_have(c.after, entry))
                c.after = media_without(c.after, entry);
            else
                c.before = media_with(c.before, entry, status);
        }
        i++;
    } while (i < crossed.count);
}

// Adds the surfaces of other media that the ray crosses at the place of `hit`. Sets `s` and
// `inside` to the surface that is seen there: the one whose material has the highest priority, and
// of equal ones one that is entered. A body that is entered twice in a row was hit at an edge, in
// both triangles. A body that is entered and left has no thickness but for rounding, or is thinner
// than the contact distance, which is not meant for it.
void gather_touching(uint slot, Ray ray, Hit hit, inout Crossed crossed, inout Crossing c,
                     inout Surface s, inout bool inside, inout uint status)
{
    float near = hit.t + crossing_slack(s, ray, hit.t);
    float reach = near + crossing_contact(s, ray);
    uint rank = medium_priority(s.material + 1u) * 2u + uint(!inside);
    bool more = frame.nested != 0u;
    do {
        if (more) {
            Hit known = hit; // the surface seen there keeps its t
            if (SPEC_NUMERICS == NUMERICS_EXACT)
                finish_hit(ray.origin, ray.dir, known);
            status |= known.status;
            hit_before = known.t;
            hit_before_at_exit = known.at_exit;
            hit = traverse(TRAVERSE_NEXT, ray.origin, ray.dir, 0.0, reach, frame.root,
                           hit.instance, hit.primitive);
            if (SPEC_COUNT != 0u)
                traversal_cost.rays = 0u; // not a new ray of the pixel
            add_cost(slot, RAY_REFRACTED);
            status |= hit.status;
            more = hit.primitive != HIT_NONE;
        }
        if (more) {
            Surface other = fetch_surface(hit);
            more = bounds_medium(fetch_material(other.material));
            bool leaves = face_ray(other, ray.dir);
            uint same = find_crossed(crossed, other.material + 1u, hit.instance);
            bool left = (crossed.leaving >> same & 1u) != 0u;
            bool again = same != CROSSED_MAX && left == leaves;
            more = more && (again || same == CROSSED_MAX || hit.t <= near);
            if (more && !again) {
                crossed.entries[crossed.count] = other.material + 1u;
                crossed.instances[crossed.count] = hit.instance;
                crossed.leaving |= uint(leaves) << crossed.count;
                crossed.count++;
                c.p = other.p;
                c.error = other.error;
                c.ng = other.ng;
                c.instance = hit.instance;
                c.record = hit.triangle;
                c.outwards = leaves;
                uint other_rank = medium_priority(other.material + 1u) * 2u + uint(!leaves);
                if (other_rank > rank) {
                    rank = other_rank;
                    other.p = s.p; // reflected rays start in front of the first surface
                    other.error = s.error;
                    s = other;
                    inside = leaves;
                }
                more = crossed.count < CROSSED_MAX;
            }
        }
    } while (more);
}

// Whether a hit is the surface that the ray has just crossed: the neighbour of a triangle that was
// crossed at its edge, which would be entered or left a second time.
bool is_crossed_already(Ray ray, Hit hit, Surface s, bool inside)
{
    return hit.instance == ray.skip_instance && hit.t <= crossing_slack(s, ray, hit.t) &&
           media_have(ray.media, s.material + 1u) != inside;
}

// Finds the media on both sides of a hit. `s` faces the ray; it may become another surface at the
// same place, which then faces the ray too.
Crossing cross_surface(uint slot, Ray ray, Hit hit, inout Surface s, inout gpu_material m,
                       bool inside, inout uint status)
{
    Crossing c;
    c.before = ray.media;
    c.after = ray.media;
    c.eta = inside ? m.ior : 1.0 / m.ior;
    c.seen = true;
    c.p = s.p;
    c.error = s.error;
    c.ng = s.ng;
    c.instance = hit.instance;
    c.record = hit.triangle;
    c.outwards = inside;
    if (SPEC_MEDIA == 0u || SPEC_CROSSINGS == 0u || !bounds_medium(m))
        return c;
    if (is_crossed_already(ray, hit, s, inside)) {
        c.seen = false;
        return c;
    }
    Crossed crossed = Crossed(uvec4(s.material + 1u, 0u, 0u, 0u), uvec4(hit.instance, 0u, 0u, 0u),
                              uint(inside), 1u);
    if (SPEC_MEDIA == MEDIA_TOUCH) {
        gather_touching(slot, ray, hit, crossed, c, s, inside, status);
        m = fetch_material(s.material);
    }
    cross_all(crossed, c, status);
    uint from = media_top(c.before), to = media_top(c.after);
    c.eta = medium_ior(from) / medium_ior(to);
    c.seen = from != to;
    return c;
}

#endif

// Packets whose rays all start, or all end, at one point (SPEC_BEAM), in trees without instances.
// For shadow rays, which end at it, boxes are tested from that point, but triangles and spheres
// from each ray's own origin.
#ifndef BIND_BEAM_GLSL
#define BIND_BEAM_GLSL

#include "packet_rays.glsl"

// A group of rays whose directions have the same dominant axis and the same signs. A packet's
// groups are traversed one after the other. Boxes are tested in the group's space: the dominant
// axis comes last, all directions point upward, and the common point is at 0.
struct Beam {
    bvec2 dominant;
    bvec3 negative;              // axes that are reversed
    vec3 eye;                    // the common point, turned so that the dominant axis is last
    vec2 inverse_lo, inverse_hi; // bounds of beam_inverse over the group's rays
};
Beam beam;
vec3 beam_inv_dir[SPEC_PACKET_RAYS]; // turned in the same way
vec3 beam_origin[SPEC_PACKET_RAYS];  // where the rays start, turned in the same way
vec2 beam_inverse[SPEC_PACKET_RAYS]; // last component of a ray's direction / the others, upwards
bool beam_left[SPEC_PACKET_RAYS];    // rays whose group is still to be traversed
bool beam_walks[SPEC_PACKET_RAYS];   // rays of the current group
vec3 beam_aside[SPEC_PACKET_RAYS];   // t, lo and hi of the hits of all other rays, saved

// A ray of the group, its dominant axis last. What all of the group share is taken from `beam`, so
// that compilers compute once what depends on it alone.
RaySetup beam_ray(uint r)
{
    RaySetup ray = packet_rays[r];
    ray.space = beam.dominant;
    ray.dominant = bvec2(false);
    ray.negative = beam.negative;
    ray.origin = SPEC_BEAM == BEAM_STARTS ? beam.eye : beam_origin[r];
    ray.inv_dir = beam_inv_dir[r];
    return ray;
}

uint group_of(RaySetup ray)
{
    uint signs = uint(ray.negative.x) | uint(ray.negative.y) << 1 | uint(ray.negative.z) << 2;
    return (ray.dominant.x ? 1u : ray.dominant.y ? 2u : 0u) | signs << 2;
}

const uint GROUP_NONE = 32u;

// Prepares the rays of the group for tests of boxes, and bounds their directions.
void bound_beam()
{
    vec2 lo = vec2(INFINITE), hi = lo; // hi holds negated values
    EACH_RAY {
        packet_unit[r] = abs(turn_dominant(beam.dominant, packet_rays[r].dir).z);
        beam_inv_dir[r] = turn_dominant(beam.dominant, packet_rays[r].inv_dir);
        beam_origin[r] = turn_dominant(beam.dominant, packet_rays[r].origin);
        packet_reach[r] = abs(beam_origin[r].z - beam.eye.z);
        vec2 inverse = lesser2(packet_unit[r] * abs(beam_inv_dir[r].xy), vec2(BOX_INVERSE_MAX));
        lo = lesser2(beam_walks[r] ? inverse : vec2(INFINITE), lo);
        hi = lesser2(beam_walks[r] ? -inverse : vec2(INFINITE), hi);
        beam_inverse[r] = inverse;
        end_ray(!beam_walks[r], r);
    }
    beam.inverse_lo = min_of_lanes2(lo);
    beam.inverse_hi = -min_of_lanes2(hi);
}

// Makes one group of the remaining rays the current one; other rays count as done until it has been
// traversed. False: no rays remain.
bool begin_beam(vec3 eye)
{
    uint own = GROUP_NONE;
    EACH_RAY own = beam_left[r] ? min(own, group_of(packet_rays[r])) : own;
    uint group = uint(min_of_lanes(int(own)));
    beam.dominant = bvec2((group & 3u) == 1u, (group & 3u) == 2u);
    bvec3 negative = notEqual(uvec3(group) & uvec3(4u, 8u, 16u), uvec3(0u));
    vec3 way = mix(vec3(1.0), vec3(-1.0), negative);
    beam.negative = lessThan(turn_dominant(beam.dominant, way), vec3(0.0));
    beam.eye = turn_dominant(beam.dominant, eye);
    EACH_RAY {
        beam_walks[r] = beam_left[r] && group_of(packet_rays[r]) == group;
        beam_left[r] = beam_left[r] && !beam_walks[r];
        beam_aside[r] = vec3(packet_hits[r].t, packet_hits[r].lo, packet_hits[r].hi);
    }
    bound_beam();
    return group != GROUP_NONE;
}

// Ends the current group, and restores the hits of the other rays. True: another group remains.
bool end_beam()
{
    bool left = false;
    EACH_RAY {
        bool aside = !beam_walks[r];
        packet_hits[r].t = aside ? beam_aside[r].x : packet_hits[r].t;
        packet_hits[r].lo = aside ? beam_aside[r].y : packet_hits[r].lo;
        packet_hits[r].hi = aside ? beam_aside[r].z : packet_hits[r].hi;
        left = left || beam_left[r];
    }
    return any_lane(left);
}

// Transforms this lane's box to the group's space and widens it. True where some ray of the group
// may hit it.
bool bring_to_beam(inout vec3 lo, inout vec3 hi)
{
    vec3 margin = vec3(box_margin(lo, hi)), eye = beam.eye;
    vec3 turned_lo = (turn_dominant(beam.dominant, lo) - eye) - margin;
    vec3 turned_hi = (turn_dominant(beam.dominant, hi) - eye) + margin;
    bvec3 negative = SPEC_BEAM == BEAM_ENDS ? not(beam.negative) : beam.negative;
    lo = mix(turned_lo, -turned_hi, negative);
    hi = mix(turned_hi, -turned_lo, negative);
    ivec3 near = floatBitsToInt(vec3(lo.xy * beam.inverse_lo, lo.z));
    ivec3 far = floatBitsToInt(vec3(hi.xy * beam.inverse_hi, hi.z));
    return max(max(near.x, near.y), max(near.z, 0)) <= min(far.x, min(far.y, far.z));
}

// The least t, as bits, at which a ray of this lane enters a box in the group's space
// (bring_to_beam); NEVER where none does.
int enter_beam_box(vec3 lo, vec3 hi)
{
    int first = NEVER;
    EACH_RAY {
        ivec3 near = floatBitsToInt(vec3(lo.xy * beam_inverse[r], lo.z));
        ivec3 far = floatBitsToInt(vec3(hi.xy * beam_inverse[r], hi.z));
        int start = max(max(near.x, near.y), max(near.z, 0));
        int end = min(min(far.x, far.y), min(far.z, packet_end[r]));
        first = start <= end ? min(first, start) : first;
    }
    return first;
}

#endif

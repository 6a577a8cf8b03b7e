// The rays of a packet: SPEC_PACKET_RAYS in each lane of a subgroup of 8.
#ifndef BIND_PACKET_RAYS_GLSL
#define BIND_PACKET_RAYS_GLSL

#include "traverse.glsl"

#define EACH_RAY [[unroll]] for (uint r = 0u; r < SPEC_PACKET_RAYS; r++)

// The place of the lane's ray `r` among the rays of its workgroup; the rays of a subgroup are
// contiguous.
uint lane_place(uint r)
{
    uint lane = gl_LocalInvocationID.x;
    return SPEC_PACKET_RAYS == 1u ? lane : (lane / 8u * SPEC_PACKET_RAYS + r) * 8u + lane % 8u;
}

// The caller's rays, and the hits that it gets.
bool packet_alive[SPEC_PACKET_RAYS];
vec3 packet_origin[SPEC_PACKET_RAYS], packet_dir[SPEC_PACKET_RAYS];
float packet_t_max[SPEC_PACKET_RAYS];
uvec2 packet_skip[SPEC_PACKET_RAYS]; // instance, primitive
Hit packet_hits[SPEC_PACKET_RAYS];
uint packet_status; // of the traversal, for all rays

RaySetup packet_rays[SPEC_PACKET_RAYS]; // in the space of the current tree
int packet_end[SPEC_PACKET_RAYS];       // bits of the t behind which nothing counts, in packet_unit
float packet_unit[SPEC_PACKET_RAYS];    // largest component of the direction
float packet_reach[SPEC_PACKET_RAYS];   // BEAM_ENDS: from the common point to the ray's start, as
                                        // above
float packet_size; // largest coordinate of an origin, and a part for clipped triangles

const float BOX_INVERSE_MAX = 16777216.0; // 2^24
#define INFINITE uintBitsToFloat(0x7f800000u)
// Relative margin of boxes: far more than the roundings of a ray, its bounds and the test of a box,
// each a few 2^-24 of the distances from the ray's ends; and more than the slack of that test
// (SLAB_FAR_SCALE, NEAR_SHARE).
const float BOUNDS_MARGIN = 1.0 / 131072.0;

int min_of_lanes(int value)
{
    value = min(value, subgroupShuffleXor(value, 1u));
    value = min(value, subgroupShuffleXor(value, 2u));
    return min(value, subgroupShuffleXor(value, 4u));
}

// A comparison and a selection; min() takes lavapipe one more instruction, because of NaN.
float lesser(float a, float b)
{
    return a < b ? a : b;
}

float min_of_lanes(float value)
{
    value = lesser(value, subgroupShuffleXor(value, 1u));
    value = lesser(value, subgroupShuffleXor(value, 2u));
    return lesser(value, subgroupShuffleXor(value, 4u));
}

vec2 lesser2(vec2 a, vec2 b)
{
    return vec2(lesser(a.x, b.x), lesser(a.y, b.y));
}

vec2 min_of_lanes2(vec2 value)
{
    return vec2(min_of_lanes(value.x), min_of_lanes(value.y));
}

vec3 min_of_lanes3(vec3 value)
{
    return vec3(min_of_lanes2(value.xy), min_of_lanes(value.z));
}

float largest_size(vec3 value)
{
    value = abs(value);
    return -lesser(-value.x, lesser(-value.y, -value.z));
}

vec3 from_lane(vec3 value, uint lane)
{
    return vec3(subgroupShuffle(value.x, lane), subgroupShuffle(value.y, lane),
                subgroupShuffle(value.z, lane));
}

// Sets how far ray `r` may still go; with `over` it is done, and hits nothing more.
void end_ray(bool over, uint r)
{
    packet_hits[r].t = over ? -1.0 : packet_hits[r].t;
    packet_hits[r].lo = over ? -1.0 : packet_hits[r].lo;
    packet_hits[r].hi = over ? -1.0 : packet_hits[r].hi;
    float end = farthest(packet_hits[r]);
    if (SPEC_BEAM == BEAM_ENDS)
        end = end < 0.0 ? end : packet_reach[r];
    else
        end *= packet_unit[r];
    packet_end[r] = floatBitsToInt(end);
}

// BEAM_ENDS: how far from `eye` a ray passes that should end there.
float distance_to_eye(RaySetup ray, vec3 eye)
{
    vec3 origin = turn_dominant(ray.dominant, ray.origin), dir = turn_dominant(ray.dominant, ray.dir);
    eye = turn_dominant(ray.dominant, eye);
    vec2 aside = abs(origin.xy + dir.xy * ((eye.z - origin.z) / dir.z) - eye.xy);
    float distance = max(aside.x, aside.y);
    return distance < INFINITE ? distance : INFINITE; // NaN counts as infinite
}

// Sets packet_size: the part of box_margin that is the same for all boxes of the tree.
void size_rays(vec3 eye)
{
    float least = 0.0; // holds negated values
    EACH_RAY {
        float own = largest_size(packet_rays[r].origin);
        if (SPEC_BEAM == BEAM_ENDS)
            own = max(own, largest_size(eye)) + distance_to_eye(packet_rays[r], eye) / BOUNDS_MARGIN;
        if (SPEC_CLIPPED != 0u)
            own += (packet_rays[r].above.x - packet_rays[r].origin.x) / BOUNDS_MARGIN;
        least = lesser(packet_alive[r] ? -own : 0.0, least);
    }
    packet_size = -min_of_lanes(least);
}

// The margin by which a box is widened: more than all roundings of its test, of transforms to
// instances (by widen_packets) and of the tests of its contents, each a few 2^-24 of the coordinates
// that go into it.
// So widened, a box that a ray runs along is hit: with BOX_INVERSE_MAX in place of infinity, rays
// miss a box only from 2^7 times its size away.
float box_margin(vec3 lo, vec3 hi)
{
    return (max(largest_size(lo), largest_size(hi)) + packet_size) * BOUNDS_MARGIN;
}

// The t, as bits, of a box that no ray enters: infinity. Such t are compared as integers, as
// lavapipe has the minimum of integers in one instruction; of negative ones only the sign matters.
const int NEVER = 0x7f800000;

#endif

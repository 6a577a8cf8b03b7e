// Traversal by the rays of a subgroup of 8 lanes together, SPEC_PACKET_RAYS of each lane: one node of eight
// children, one record at a time for all of them. Each lane fetches one child, and the others get it by
// shuffles, which lavapipe has single instructions for; the stack is a few registers whose lanes are
// children. Rays of a packet are tested against more records than alone, and hits do not depend on that
// (docs/numerics.md). All lanes must be here; rays that are none are not `alive`.
#ifndef BIND_PACKET_GLSL
#define BIND_PACKET_GLSL

#include "traverse.glsl"

layout(set = 0, binding = BIND_NODE8_TEXELS) uniform usamplerBuffer node8_texels;

#define EACH_RAY [[unroll]] for (uint r = 0u; r < SPEC_PACKET_RAYS; r++)

// What the caller asks for, and gets.
bool packet_alive[SPEC_PACKET_RAYS];
vec3 packet_origin[SPEC_PACKET_RAYS], packet_dir[SPEC_PACKET_RAYS];
float packet_t_max[SPEC_PACKET_RAYS];
uvec2 packet_skip[SPEC_PACKET_RAYS]; // instance, primitive
Hit packet_hits[SPEC_PACKET_RAYS];

// In the space of the tree in hand, and in that of the tree over instances.
RaySetup packet_rays[SPEC_PACKET_RAYS], packet_world[SPEC_PACKET_RAYS];

// The same rays as boxes are tested with: t in units of the largest component of the direction, so that
// `inverse` is at least 1; and at most BOX_INVERSE_MOST, see box_margin.
struct BoxRay {
    vec3 origin, inverse, size; // size: |inverse|
    float unit;                 // that component
};
BoxRay packet_box_rays[SPEC_PACKET_RAYS], packet_world_box_rays[SPEC_PACKET_RAYS];
int packet_end[SPEC_PACKET_RAYS]; // bits of the t behind which nothing counts, in these units
float packet_size;                // largest coordinate of an origin, and what clipped triangles take
const float BOX_INVERSE_MOST = 16777216.0; // 2^24

// Entry i: what is left to visit of a node's children, nearest first, the lanes behind them REF_DONE.
uint packet_stack[SPEC_PACKET_STACK];
uint packet_height;

// Intervals of origins and directions that all rays lie in. Shadow rays to a point are taken from there.
struct PacketBounds {
    vec3 origin_lo, origin_hi;
    vec3 to_up, to_down; // 1 / most upward component; 1 / most downward one; infinite where none is
    vec3 last;           // 1 / least component of rays that all go one way; else infinite
    bvec3 up;            // that way
    float size;          // what margins are relative to, beside the distance of a box
    float t_most;
};
PacketBounds packet_bounds;

#define INFINITE uintBitsToFloat(0x7f800000u)
// Far more than the roundings of a ray, its bounds and the test of a box, each a few 2^-24 of the distances
// from the ray's ends; and than the slack of that test (SLAB_FAR_SCALE, SLAB_NEAR_SCALE).
const float BOUNDS_MARGIN = 1.0 / 131072.0;

int least_of_lanes(int value)
{
    value = min(value, subgroupShuffleXor(value, 1u));
    value = min(value, subgroupShuffleXor(value, 2u));
    return min(value, subgroupShuffleXor(value, 4u));
}

float least_of_lanes(float value)
{
    value = min(value, subgroupShuffleXor(value, 1u));
    value = min(value, subgroupShuffleXor(value, 2u));
    return min(value, subgroupShuffleXor(value, 4u));
}

vec3 least_of_lanes3(vec3 value)
{
    return vec3(least_of_lanes(value.x), least_of_lanes(value.y), least_of_lanes(value.z));
}

vec3 inverse_or_infinite(vec3 value)
{
    return mix(vec3(INFINITE), vec3(1.0) / value, greaterThan(value, vec3(0.0)));
}

void make_packet_bounds(const uint mode)
{
    vec3 o_lo = vec3(INFINITE), o_hi = o_lo, d_lo = o_lo, d_hi = o_lo; // o_hi, d_hi: negated
    bool backwards = false;
    EACH_RAY {
        vec3 o = packet_rays[r].origin, d = packet_rays[r].dir;
        bool to_point = mode == TRAVERSE_SHADOW && packet_t_max[r] < FLOAT_LARGEST;
        if (to_point) {
            d *= packet_t_max[r];
            o += d;
            d = -d;
        }
        if (packet_alive[r]) {
            backwards = backwards || to_point;
            o_lo = min(o_lo, o);
            o_hi = min(o_hi, -o);
            d_lo = min(d_lo, d);
            d_hi = min(d_hi, -d);
        }
    }
    PacketBounds b;
    b.origin_lo = least_of_lanes3(o_lo);
    b.origin_hi = -least_of_lanes3(o_hi);
    d_lo = least_of_lanes3(d_lo);
    d_hi = -least_of_lanes3(d_hi);
    b.to_up = inverse_or_infinite(d_hi);
    b.to_down = inverse_or_infinite(-d_lo);
    b.up = greaterThan(d_lo, vec3(0.0));
    b.last = inverse_or_infinite(mix(-d_hi, d_lo, b.up));
    vec3 size = max(abs(b.origin_lo), abs(b.origin_hi));
    backwards = mode == TRAVERSE_SHADOW && any_lane(backwards);
    if (backwards)
        size += max(abs(d_lo), abs(d_hi));
    b.size = max(size.x, max(size.y, size.z));
    b.t_most = backwards ? 1.0 + BOUNDS_MARGIN : INFINITE;
    packet_bounds = b;
}

BoxRay make_box_ray(RaySetup ray)
{
    BoxRay box;
    vec3 size = abs(ray.dir);
    box.origin = ray.origin;
    box.unit = max(size.x, max(size.y, size.z));
    box.size = min(abs(box.unit * ray.inv_dir), vec3(BOX_INVERSE_MOST));
    box.inverse = mix(box.size, -box.size, ray.negative);
    return box;
}

// Of packet_rays, which are those of a tree now.
void make_box_rays(const uint mode)
{
    float size = 0.0;
    EACH_RAY {
        RaySetup ray = packet_rays[r];
        packet_box_rays[r] = make_box_ray(ray);
        packet_end[r] = floatBitsToInt(farthest(packet_hits[r]) * packet_box_rays[r].unit);
        vec3 far = abs(ray.origin);
        float own = max(far.x, max(far.y, far.z));
        if (SPEC_CLIPPED != 0u)
            own += (ray.above.x - ray.origin.x) / BOUNDS_MARGIN;
        size = packet_alive[r] ? max(size, own) : size;
    }
    packet_size = -least_of_lanes(-size);
    if (SPEC_BOUNDED != 0u)
        make_packet_bounds(mode);
}

// Whether some ray within the bounds may come through the box.
bool may_be_met(vec3 box_lo, vec3 box_hi)
{
    PacketBounds b = packet_bounds;
    vec3 lo = box_lo - b.origin_hi, hi = box_hi - b.origin_lo;
    vec3 reach = max(abs(lo), abs(hi));
    float margin = (max(reach.x, max(reach.y, reach.z)) + b.size) * BOUNDS_MARGIN;
    lo -= margin;
    hi += margin;
    vec3 ahead = mix(-hi * b.to_down, lo * b.to_up, greaterThan(lo, vec3(0.0)));
    bvec3 apart = bvec3(lo.x > 0.0 || hi.x < 0.0, lo.y > 0.0 || hi.y < 0.0, lo.z > 0.0 || hi.z < 0.0);
    vec3 near = mix(vec3(0.0), ahead, apart);
    vec3 far = max(mix(-lo, hi, b.up), vec3(0.0)) * b.last; // a box behind is too far by `near`
    float start = max(near.x, max(near.y, near.z));
    float end = b.t_most;
    end = far.x < end ? far.x : end; // false for NaN
    end = far.y < end ? far.y : end;
    end = far.z < end ? far.z : end;
    return start <= end * (1.0 + BOUNDS_MARGIN);
}

void push_packet(uint entry, bool wanted)
{
    [[unroll]] for (uint i = 0u; i < SPEC_PACKET_STACK; i++)
        packet_stack[i] = wanted && packet_height == i ? entry : packet_stack[i];
    if (wanted && packet_height >= SPEC_PACKET_STACK)
        packet_hits[0].status |= STATUS_NODE_STACK_OVERFLOW;
    packet_height += uint(wanted);
}

// Splits off the first of an entry, the others of which are pushed.
uint take_first(uint entry, bool wanted)
{
    uint lane = gl_SubgroupInvocationID;
    uint rest = subgroupShuffle(entry, (lane + 1u) & 7u);
    rest = lane == 7u ? REF_DONE : rest;
    push_packet(rest, wanted && subgroupShuffle(rest, 0u) != REF_DONE);
    return subgroupShuffle(entry, 0u);
}

// `ref` itself where nothing is `wanted`.
uint pop_packet(bool wanted, uint ref, uint base)
{
    bool some = wanted && packet_height > base;
    uint entry = REF_DONE;
    [[unroll]] for (uint i = 0u; i < SPEC_PACKET_STACK; i++)
        entry = packet_height == i + 1u ? packet_stack[i] : entry;
    packet_height -= uint(some);
    uint first = take_first(entry, some);
    return wanted ? (some ? first : REF_DONE) : ref;
}

// Boxes are widened by more than all roundings of their tests, of transforms to instances and of the tests
// of what is inside, each of which is a few 2^-24 of the coordinates that go into it. So wide, a box that a
// ray runs along is met: with BOX_INVERSE_MOST in place of infinity it is left 2^7 times as far away as it
// is large.
float box_margin(vec3 middle, vec3 half_size)
{
    vec3 far = abs(middle) + half_size;
    return (max(far.x, max(far.y, far.z)) + packet_size) * BOUNDS_MARGIN;
}

// Where the first ray of this lane enters the box, as bits; NEVER where none does. Integers, as lavapipe
// has single instructions for their minima: negative floats are negative integers, which is all that
// matters of them here.
const int NEVER = 0x7f800000;

int enter_box(vec3 middle, vec3 half_size)
{
    int first = NEVER;
    EACH_RAY {
        BoxRay ray = packet_box_rays[r];
        vec3 at = (middle - ray.origin) * ray.inverse;
        vec3 half_way = half_size * ray.size;
        ivec3 near = floatBitsToInt(at - half_way), far = floatBitsToInt(at + half_way);
        int start = max(max(near.x, near.y), max(near.z, 0));
        int end = min(min(far.x, far.y), min(far.z, packet_end[r]));
        first = start <= end ? min(first, start) : first;
    }
    return first;
}

vec3 from_lane(vec3 value, uint lane)
{
    return vec3(subgroupShuffle(value.x, lane), subgroupShuffle(value.y, lane),
                subgroupShuffle(value.z, lane));
}

// Minima over two lanes `span` apart: of `lower` in the one that has not that bit, of `upper` in the other.
int least_of_halves(int lower, int upper, uint span)
{
    bool up = (gl_SubgroupInvocationID & span) != 0u;
    return min(up ? upper : lower, subgroupShuffleXor(up ? lower : upper, span));
}

// Of child `lane`, its first entry.
int enter_children(vec3 lo, vec3 hi, bool wanted)
{
    uint lane = gl_SubgroupInvocationID;
    vec3 middle = lo * 0.5 + hi * 0.5, half_size = hi * 0.5 - lo * 0.5;
    half_size += box_margin(middle, half_size);
    if (SPEC_BOUNDED != 0u) {
        uint left = gather_lanes(wanted && may_be_met(lo, hi) ? 1u << lane : 0u);
        int own = NEVER;
        do {
            uint child = uint(findLSB(left)) & 7u;
            int first =
                least_of_lanes(enter_box(from_lane(middle, child), from_lane(half_size, child)));
            own = left != 0u && lane == child ? first : own;
            left &= left - 1u;
        } while (left != 0u);
        return own;
    }
    int first[8];
    [[unroll]] for (uint child = 0u; child < 8u; child++)
        first[child] = enter_box(from_lane(middle, child), from_lane(half_size, child));
    // Minima over lanes of all eight at once, child by lane. Written out: lavapipe keeps the array in memory
    // where it cannot count the turns of a loop.
    [[unroll]] for (uint child = 0u; child < 4u; child++)
        first[child] = least_of_halves(first[child], first[child + 4u], 4u);
    first[0] = least_of_halves(first[0], first[2], 2u);
    first[1] = least_of_halves(first[1], first[3], 2u);
    first[0] = least_of_halves(first[0], first[1], 1u);
    return wanted ? first[0] : NEVER;
}

// One stage of Batcher's bitonic sorter over the lanes.
uint sort_stage(uint key, uint span, bool ascending)
{
    uint other = subgroupShuffleXor(key, span);
    bool lower = (gl_SubgroupInvocationID & span) == 0u;
    return lower == ascending ? min(key, other) : max(key, other);
}

// The children of a node that rays come to, nearest first; REF_DONE behind them.
uint sort_children(uint ref, int entered)
{
    uint lane = gl_SubgroupInvocationID;
    uint key = entered < NEVER ? (uint(entered) & ~7u) | lane : 0xffffffffu;
    key = sort_stage(key, 1u, (lane & 2u) == 0u);
    key = sort_stage(key, 2u, (lane & 4u) == 0u);
    key = sort_stage(key, 1u, (lane & 4u) == 0u);
    key = sort_stage(key, 4u, true);
    key = sort_stage(key, 2u, true);
    key = sort_stage(key, 1u, true);
    uint sorted = subgroupShuffle(ref, key & 7u);
    return key == 0xffffffffu ? REF_DONE : sorted;
}

uint step_packet(uint node, uint base)
{
    int row = int(node * 16u + gl_SubgroupInvocationID * 2u);
    uvec4 r0 = texelFetch(node8_texels, row), r1 = texelFetch(node8_texels, row + 1);
    uint ref = (r1.w << BVH_COUNT_SHIFT) | r0.w;
    int entered = enter_children(row_vec3(r0), row_vec3(r1), ref != REF_DONE);
    uint entry = sort_children(ref, entered);
    uint first = take_first(entry, true);
    return pop_packet(first == REF_DONE, first, base);
}

RecordRows fetch_packet_record(uint record)
{
    uvec4 row = fetch_triangle_row(record * TRIANGLE_ROWS + min(gl_SubgroupInvocationID, 2u));
    RecordRows rows;
    rows.r0 = subgroupShuffle(row, 0u);
    rows.r1 = subgroupShuffle(row, 1u);
    rows.r2 = has_third_row() ? subgroupShuffle(row, 2u) : uvec4(0u);
    return rows;
}

// A ray that is done meets nothing more.
void end_ray(bool over, uint r)
{
    packet_hits[r].t = over ? -1.0 : packet_hits[r].t;
    packet_hits[r].lo = over ? -1.0 : packet_hits[r].lo;
    packet_hits[r].hi = over ? -1.0 : packet_hits[r].hi;
    packet_end[r] = floatBitsToInt(farthest(packet_hits[r]) * packet_box_rays[r].unit);
}

// The ref behind a leaf's record that was tested.
uint next_packet_ref(const uint mode, uint ref, uint base)
{
    ref += 1u - REF_ONE_PRIMITIVE;
    ref = pop_packet(is_inner(ref), ref, base);
    bool going = false;
    EACH_RAY going = going || packet_hits[r].t >= 0.0;
    bool ends = SPEC_NUMERICS == NUMERICS_EXACT || !finds_closest(mode);
    return ends && !any_lane(going) ? REF_DONE : ref;
}

// Goes on through a mesh tree at `ref` until REF_DONE, or until a record waits for some ray. Only packets
// of one ray a lane have records that wait.
void walk_packet(const uint mode, float t_min, uint instance, uint base, inout uint ref,
                 out bool own_waits, out bool waits)
{
    own_waits = false;
    waits = false;
    do {
        do {
            if (is_inner(ref))
                ref = step_packet(ref, base);
        } while (is_inner(ref));
        do {
            if (is_leaf(ref)) {
                uint record = ref & BVH_FIRST_MASK;
                RecordRows rows = fetch_packet_record(record);
                EACH_RAY {
                    bool done = test_rows(mode, packet_rays[r], t_min, record, rows, instance,
                                          packet_skip[r].x, packet_skip[r].y, packet_hits[r],
                                          own_waits);
                    end_ray(done, r);
                }
                if (has_looks(mode))
                    waits = any_lane(own_waits);
                if (!waits)
                    ref = next_packet_ref(mode, ref, base);
            }
        } while (is_leaf(ref) && !waits);
    } while (another_turn(ref != REF_DONE && !waits));
    if (ref != REF_DONE && !waits)
        packet_hits[0].status |= STATUS_UNFINISHED_TRAVERSAL;
}

// Looks at the record at `ref` for the rays that wait, and goes on to the next.
void look_at_packet_leaf(const uint mode, float t_min, uint instance, uint base, bool own_waits,
                         inout uint ref)
{
    uint record = ref & BVH_FIRST_MASK;
    RecordRows rows = fetch_packet_record(record);
    Hit looked = packet_hits[0]; // all lanes look: what is fetched for all is fetched by some
    bool over = look_at_rows(mode, packet_rays[0], packet_origin[0], packet_dir[0], t_min, record,
                             rows, instance, packet_skip[0].x, packet_skip[0].y, looked);
    if (own_waits)
        packet_hits[0] = looked;
    end_ray(own_waits && over, 0u);
    ref = next_packet_ref(mode, ref, base);
}

void packet_mesh(const uint mode, float t_min, uint root)
{
    uint ref = root;
    do {
        bool own_waits, waits;
        walk_packet(mode, t_min, 0u, 0u, ref, own_waits, waits);
        if (has_looks(mode) && waits)
            look_at_packet_leaf(mode, t_min, 0u, 0u, own_waits, ref);
    } while (has_looks(mode) && another_turn(ref != REF_DONE));
    if (ref != REF_DONE)
        packet_hits[0].status |= STATUS_UNFINISHED_TRAVERSAL;
}

void enter_instance(const uint mode, uint instance)
{
    EACH_RAY packet_rays[r] = make_local_setup(instance, packet_origin[r], packet_dir[r]);
    make_box_rays(mode);
}

void packet_instances(const uint mode, float t_min, uint root)
{
    PacketBounds bounds = packet_bounds;
    uint ref = root, mesh_ref = REF_DONE, base = 0u;
    bool inside = false, own_waits = false, waits = false;
    float world_size = packet_size;
    EACH_RAY {
        packet_world[r] = packet_rays[r];
        packet_world_box_rays[r] = packet_box_rays[r];
    }
    do {
        do {
            do {
                if (is_inner(ref) && !inside)
                    ref = step_packet(ref, 0u);
            } while (is_inner(ref) && !inside);
            if (is_leaf(ref)) {
                uint instance = ref & BVH_FIRST_MASK;
                if (!inside) {
                    enter_instance(mode, instance);
                    mesh_ref = fetch_instance_row(instance * INSTANCE_ROWS + 7u).y;
                    base = packet_height;
                }
                walk_packet(mode, t_min, instance, base, mesh_ref, own_waits, waits);
                bool going = false;
                EACH_RAY going = going || packet_hits[r].t >= 0.0;
                bool ends = SPEC_NUMERICS == NUMERICS_EXACT || !finds_closest(mode);
                bool over = ends && !any_lane(going);
                if (!waits) {
                    packet_height = base;
                    ref = pop_packet(true, ref, 0u);
                    ref = over ? REF_DONE : ref;
                    EACH_RAY {
                        packet_rays[r] = packet_world[r];
                        packet_box_rays[r] = packet_world_box_rays[r];
                        end_ray(false, r);
                    }
                    packet_bounds = bounds;
                    packet_size = world_size;
                }
                inside = false;
            }
        } while (another_turn(ref != REF_DONE && !waits));
        if (ref != REF_DONE && !waits)
            packet_hits[0].status |= STATUS_UNFINISHED_TRAVERSAL;
        inside = has_looks(mode);
        if (has_looks(mode) && waits)
            look_at_packet_leaf(mode, t_min, ref & BVH_FIRST_MASK, base, own_waits, mesh_ref);
        waits = false;
    } while (has_looks(mode) && another_turn(ref != REF_DONE));
    if (ref != REF_DONE)
        packet_hits[0].status |= STATUS_UNFINISHED_TRAVERSAL;
}

// traverse() for all rays of the subgroup, from packet_origin and the like into packet_hits.
void traverse_packets(const uint mode, float t_min, uint root, uint root8)
{
    if (SPEC_PACKETS == 0u) {
        EACH_RAY packet_hits[r] =
            traverse(mode, packet_origin[r], packet_dir[r], t_min, packet_t_max[r],
                     packet_alive[r] ? root : REF_DONE, packet_skip[r].x, packet_skip[r].y);
        return;
    }
    if (SPEC_NUMERICS == NUMERICS_EXACT && t_min < 0.0) // behind the origin nothing is hit
        t_min = 0.0;
    bool some = false;
    EACH_RAY {
        packet_alive[r] = packet_alive[r] && is_usable(packet_origin[r], packet_dir[r]);
        some = some || packet_alive[r];
        packet_hits[r] = make_hit(packet_t_max[r]);
        end_ray(!packet_alive[r], r);
        packet_rays[r] = make_ray_setup(packet_alive[r] ? packet_origin[r] : vec3(0.0),
                                        packet_alive[r] ? packet_dir[r] : vec3(1.0));
        if (SPEC_INSTANCED == 0u && SPEC_CLIPPED != 0u)
            widen_ray_setup(packet_rays[r], fetch_mesh_center(0u), fetch_mesh_reach(0u));
    }
    packet_height = 0u;
    make_box_rays(mode);
    root8 = any_lane(some) ? root8 : REF_DONE;
    if (SPEC_INSTANCED != 0u)
        packet_instances(mode, t_min, root8);
    else
        packet_mesh(mode, t_min, root8);
    EACH_RAY {
        if (packet_hits[r].primitive == HIT_NONE)
            packet_hits[r].t = make_hit(packet_t_max[r]).t;
    }
}

#endif

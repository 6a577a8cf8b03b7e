// Traversal by ray packets: the rays of a subgroup of 8 lanes, SPEC_PACKET_RAYS in each, visit one
// node of eight children, or one record, at a time. Each lane fetches one child, and the others get
// it by shuffles, which lavapipe has single instructions for; the stack is a few registers whose
// lanes are children. Rays of a packet are tested against more records than alone, and hits do not
// depend on that (docs/numerics.md). All lanes must take part; lanes without a ray have
// packet_alive false.
#ifndef BIND_PACKET_GLSL
#define BIND_PACKET_GLSL

#include "beam.glsl"

layout(set = 0, binding = BIND_NODE8_TEXELS) uniform usamplerBuffer node8_texels;

RaySetup packet_world[SPEC_PACKET_RAYS]; // packet_rays in the space of the tree over instances

// The packet's rays in the form in which boxes are tested: t is in units of the largest component
// of the direction, so that `inverse` is at least 1; and at most BOX_INVERSE_MAX, see box_margin.
struct BoxRay {
    vec3 origin, inverse, size; // size: |inverse|
};
BoxRay packet_box_rays[SPEC_PACKET_RAYS], packet_world_box_rays[SPEC_PACKET_RAYS];

// packet_top: the children of the current node that are left to visit, one in each lane, nearest
// first, REF_DONE behind them. packet_stack: the same for the nodes above, from the root down.
uint packet_top;
uint packet_stack[SPEC_PACKET_STACK];
uint packet_height;

// Bounds of the origins and directions of all rays. A shadow ray to a point counts from that point,
// with its direction reversed.
struct PacketBounds {
    vec3 origin_lo, origin_hi;
    vec3 to_up, to_down; // 1 / the largest upward component; 1 / the largest downward one; infinite
                         // where there is none
    vec3 last;           // 1 / the least component where all rays go one way; else infinite
    bvec3 up;            // they go upwards there
    float size;          // size that margins are relative to, besides the distance of a box
    float t_max;
};
PacketBounds packet_bounds;

vec3 inverse_or_infinite(vec3 value)
{
    return mix(vec3(INFINITE), vec3(1.0) / value, greaterThan(value, vec3(0.0)));
}

void make_packet_bounds(const uint mode)
{
    vec3 o_lo = vec3(INFINITE), o_hi = o_lo, d_lo = o_lo, d_hi = o_lo; // o_hi, d_hi hold negated values
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
    b.origin_lo = min_of_lanes3(o_lo);
    b.origin_hi = -min_of_lanes3(o_hi);
    d_lo = min_of_lanes3(d_lo);
    d_hi = -min_of_lanes3(d_hi);
    b.to_up = inverse_or_infinite(d_hi);
    b.to_down = inverse_or_infinite(-d_lo);
    b.up = greaterThan(d_lo, vec3(0.0));
    b.last = inverse_or_infinite(mix(-d_hi, d_lo, b.up));
    vec3 size = max(abs(b.origin_lo), abs(b.origin_hi));
    backwards = mode == TRAVERSE_SHADOW && any_lane(backwards);
    if (backwards)
        size += max(abs(d_lo), abs(d_hi));
    b.size = max(size.x, max(size.y, size.z));
    b.t_max = backwards ? 1.0 + BOUNDS_MARGIN : INFINITE;
    packet_bounds = b;
}

// Makes the box rays and the bounds from packet_rays, which are in the space of the tree to
// traverse.
void make_box_rays(const uint mode)
{
    EACH_RAY {
        RaySetup ray = packet_rays[r];
        vec3 size = abs(ray.dir);
        packet_unit[r] = max(size.x, max(size.y, size.z));
        size = min(abs(packet_unit[r] * ray.inv_dir), vec3(BOX_INVERSE_MAX));
        packet_box_rays[r] = BoxRay(ray.origin, mix(size, -size, ray.negative), size);
        end_ray(false, r);
    }
    size_rays(vec3(0.0));
    make_packet_bounds(mode);
}

// Whether some ray within the bounds may hit the box.
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
    vec3 far = max(mix(-lo, hi, b.up), vec3(0.0)) * b.last; // `near` excludes boxes behind the rays
    float start = max(near.x, max(near.y, near.z));
    float end = b.t_max;
    end = far.x < end ? far.x : end; // false for NaN
    end = far.y < end ? far.y : end;
    end = far.z < end ? far.z : end;
    return start <= end * (1.0 + BOUNDS_MARGIN);
}

// Whether a stack entry holds a ref, by its lane 0. The lane is gl_WorkGroupID.y, which compilers
// do not know to be 0 (see turn.glsl): of a lane that they know lavapipe would make a scalar, and a
// jump of every selection by it.
bool is_filled(uint entry)
{
    return subgroupShuffle(entry, gl_WorkGroupID.y) != REF_DONE;
}

// Puts another entry on top, if it holds any refs (`some`).
void push_packet(uint entry, bool some)
{
    bool keep = some && is_filled(packet_top);
    if (keep && packet_height >= SPEC_PACKET_STACK)
        packet_status |= STATUS_NODE_STACK_OVERFLOW;
    [[unroll]] for (uint i = 0u; i < SPEC_PACKET_STACK; i++)
        packet_stack[i] = keep && packet_height == i ? packet_top : packet_stack[i];
    packet_height += uint(keep);
    packet_top = some ? entry : packet_top;
}

// Pops the nearest ref; `ref` itself where not `wanted`, REF_DONE where nothing is left above `base`.
uint pop_packet(bool wanted, uint ref, uint base)
{
    bool empty = wanted && !is_filled(packet_top) && packet_height > base;
    [[unroll]] for (uint i = 0u; i < SPEC_PACKET_STACK; i++)
        packet_top = empty && packet_height == i + 1u ? packet_stack[i] : packet_top;
    packet_height -= uint(empty);
    uint lane = gl_SubgroupInvocationID, first = subgroupShuffle(packet_top, 0u);
    uint rest = subgroupShuffle(packet_top, (lane + 1u) & 7u);
    rest = lane == 7u ? REF_DONE : rest;
    packet_top = wanted ? rest : packet_top;
    return wanted ? first : ref;
}

// The least t, as bits, at which a ray of this lane enters the widened box; NEVER where none does.
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

// Each lane passes the box of one child. It gets the least t, as bits, at which a ray of the packet
// enters that box; NEVER where none does.
int enter_children(vec3 lo, vec3 hi, bool wanted)
{
    uint lane = gl_SubgroupInvocationID;
    vec3 a = lo, b = hi;
    if (SPEC_BEAM != BEAM_NONE) {
        wanted = wanted && bring_to_beam(a, b);
    } else {
        wanted = wanted && may_be_met(lo, hi);
        a = lo * 0.5 + hi * 0.5;
        b = hi * 0.5 - lo * 0.5 + box_margin(lo, hi);
    }
    uint left = gather_lanes(wanted ? 1u << lane : 0u);
    int own = NEVER;
    do {
        uint child = uint(findLSB(left)) & 7u;
        vec3 child_a = from_lane(a, child), child_b = from_lane(b, child);
        int first = SPEC_BEAM != BEAM_NONE ? enter_beam_box(child_a, child_b)
                                             : enter_box(child_a, child_b);
        first = min_of_lanes(first);
        own = left != 0u && lane == child ? first : own;
        left &= left - 1u;
    } while (left != 0u);
    return own;
}

// One stage of Batcher's bitonic sorter over the lanes.
uint sort_stage(uint key, uint span, bool ascending)
{
    uint other = subgroupShuffleXor(key, span);
    bool lower = (gl_SubgroupInvocationID & span) == 0u;
    return lower == ascending ? min(key, other) : max(key, other);
}

// Sorts the children of a node that rays enter, nearest first, over the lanes; REF_DONE behind
// them.
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
    if (SPEC_COUNT != 0u)
        traversal_cost.inner_nodes++;
    int row = int(node * 16u + gl_SubgroupInvocationID * 2u);
    uvec4 r0 = texelFetch(node8_texels, row), r1 = texelFetch(node8_texels, row + 1);
    uint ref = (r1.w << BVH_COUNT_SHIFT) | r0.w;
    int entered = enter_children(row_vec3(r0), row_vec3(r1), ref != REF_DONE);
    uint entry = sort_children(ref, entered);
    push_packet(entry, is_filled(entry));
    return pop_packet(true, node, base);
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

RaySetup packet_ray(uint r)
{
    if (SPEC_BEAM != BEAM_NONE)
        return beam_ray(r);
    return packet_rays[r];
}

// The ref to visit after the record of a leaf at `ref` has been tested.
uint next_packet_ref(const uint mode, uint ref, uint base)
{
    ref += 1u - REF_ONE_PRIMITIVE;
    ref = pop_packet(is_inner(ref), ref, base);
    bool going = false;
    EACH_RAY going = going || farthest(packet_hits[r]) >= 0.0;
    bool ends = SPEC_NUMERICS == NUMERICS_EXACT || !finds_closest(mode);
    return ends && !any_lane(going) ? REF_DONE : ref;
}

// Traverses a mesh tree from `ref` on until REF_DONE, or until the record at `ref` is `deferred`
// for some ray. Only packets with one ray per lane defer records.
void walk_packet(const uint mode, float t_min, uint instance, uint base, inout uint ref,
                 out bool lane_deferred, out bool deferred)
{
    lane_deferred = false;
    deferred = false;
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
                    bool done = test_rows(mode, packet_ray(r), t_min, record, rows, instance,
                                          packet_skip[r].x, packet_skip[r].y, packet_hits[r],
                                          lane_deferred);
                    end_ray(done, r);
                }
                if (settles(mode))
                    deferred = any_lane(lane_deferred);
                if (!deferred)
                    ref = next_packet_ref(mode, ref, base);
            }
        } while (is_leaf(ref) && !deferred);
    } while (another_iteration(ref != REF_DONE && !deferred));
    if (ref != REF_DONE && !deferred)
        packet_status |= STATUS_UNFINISHED_TRAVERSAL;
}

// Tests the record at `ref` in full for the rays that have deferred it, and goes on to the next.
void look_at_packet_leaf(const uint mode, float t_min, uint instance, uint base, bool lane_deferred,
                         inout uint ref)
{
    uint record = ref & BVH_FIRST_MASK;
    RecordRows rows = fetch_packet_record(record);
    Hit looked = packet_hits[0]; // all lanes do it, since each fetches a part for all
    bool over = look_at_rows(mode, packet_rays[0], packet_origin[0], packet_dir[0], t_min, record,
                             rows, instance, packet_skip[0].x, packet_skip[0].y, looked);
    if (lane_deferred)
        packet_hits[0] = looked;
    end_ray(lane_deferred && over, 0u);
    ref = next_packet_ref(mode, ref, base);
}

void packet_mesh(const uint mode, float t_min, uint root)
{
    uint ref = root;
    do {
        bool lane_deferred, deferred;
        walk_packet(mode, t_min, 0u, 0u, ref, lane_deferred, deferred);
        if (settles(mode) && deferred)
            look_at_packet_leaf(mode, t_min, 0u, 0u, lane_deferred, ref);
    } while (settles(mode) && another_iteration(ref != REF_DONE));
    if (ref != REF_DONE)
        packet_status |= STATUS_UNFINISHED_TRAVERSAL;
}

void enter_instance(const uint mode, uint instance)
{
    EACH_RAY packet_rays[r] = make_local_setup(instance, packet_origin[r], packet_dir[r]);
    make_box_rays(mode);
}

// Raises packet_size where transforms to instances are rounded by more than BOUNDS_MARGIN of it.
void widen_packets()
{
    vec3 own, others;
    fetch_slack(own, others);
    packet_size *= max(1.0, largest_size(own + others) / BOUNDS_MARGIN);
}

void packet_instances(const uint mode, float t_min, uint root)
{
    widen_packets();
    PacketBounds bounds = packet_bounds;
    uint ref = root, mesh_ref = REF_DONE, base = 0u;
    bool inside = false, lane_deferred = false, deferred = false;
    float world_size = packet_size, world_unit[SPEC_PACKET_RAYS];
    EACH_RAY {
        world_unit[r] = packet_unit[r];
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
                    push_packet(REF_DONE, true);
                    base = packet_height;
                }
                walk_packet(mode, t_min, instance, base, mesh_ref, lane_deferred, deferred);
                bool going = false;
                EACH_RAY going = going || farthest(packet_hits[r]) >= 0.0;
                bool ends = SPEC_NUMERICS == NUMERICS_EXACT || !finds_closest(mode);
                bool over = ends && !any_lane(going);
                if (!deferred) {
                    ref = pop_packet(true, ref, 0u);
                    ref = over ? REF_DONE : ref;
                    EACH_RAY {
                        packet_rays[r] = packet_world[r];
                        packet_box_rays[r] = packet_world_box_rays[r];
                        packet_unit[r] = world_unit[r];
                        end_ray(false, r);
                    }
                    packet_bounds = bounds;
                    packet_size = world_size;
                }
                inside = false;
            }
        } while (another_iteration(ref != REF_DONE && !deferred));
        if (ref != REF_DONE && !deferred)
            packet_status |= STATUS_UNFINISHED_TRAVERSAL;
        inside = settles(mode);
        if (settles(mode) && deferred)
            look_at_packet_leaf(mode, t_min, ref & BVH_FIRST_MASK, base, lane_deferred, mesh_ref);
        deferred = false;
    } while (settles(mode) && another_iteration(ref != REF_DONE));
    if (ref != REF_DONE)
        packet_status |= STATUS_UNFINISHED_TRAVERSAL;
}

// Traverses packets of rays that start or end at `eye`, one group of directions after the other.
void packet_beams(const uint mode, float t_min, uint root, vec3 eye)
{
    bool more = false;
    EACH_RAY beam_left[r] = packet_alive[r];
    size_rays(eye);
    do {
        bool some = begin_beam(eye);
        packet_height = 0u;
        packet_top = REF_DONE;
        packet_mesh(mode, t_min, some ? root : REF_DONE);
        more = end_beam();
    } while (another_iteration(more));
    if (more)
        packet_status |= STATUS_UNFINISHED_TRAVERSAL;
}

// traverse() for all rays of the subgroup: reads packet_origin and the like, and writes
// packet_hits. With SPEC_BEAM all alive rays start or end at `eye`.
void traverse_packets(const uint mode, float t_min, uint root, uint root8, vec3 eye)
{
    if (SPEC_PACKETS == 0u) {
        EACH_RAY {
            packet_hits[r] =
                traverse(mode, packet_origin[r], packet_dir[r], t_min, packet_t_max[r],
                         packet_alive[r] ? root : REF_DONE, packet_skip[r].x, packet_skip[r].y);
        }
        return;
    }
    if (SPEC_NUMERICS == NUMERICS_EXACT && t_min < 0.0) // nothing is hit behind the origin
        t_min = 0.0;
    packet_status = 0u;
    packet_height = 0u;
    packet_top = REF_DONE;
    if (SPEC_COUNT != 0u)
        traversal_cost = gpu_cost(1u, 0u, 0u, 0u, 0u, 0u, 0u, 0u);
    bool some = false;
    EACH_RAY {
        packet_alive[r] = packet_alive[r] && is_usable(packet_origin[r], packet_dir[r]);
        some = some || packet_alive[r];
        packet_hits[r] = make_hit(packet_t_max[r]);
        if (mode == TRAVERSE_SHADOW)
            packet_hits[r].filter_end = filter_end(packet_origin[r], packet_t_max[r]);
        end_ray(!packet_alive[r], r);
        vec3 origin = packet_alive[r] ? packet_origin[r] : vec3(0.0);
        packet_rays[r] = make_ray_setup(SPEC_BEAM == BEAM_STARTS ? eye : origin,
                                        packet_alive[r] ? packet_dir[r] : vec3(1.0));
        if (SPEC_INSTANCED == 0u && SPEC_CLIPPED != 0u)
            widen_ray_setup(packet_rays[r], fetch_mesh_center(0u), fetch_mesh_reach(0u));
    }
    root8 = any_lane(some) ? root8 : REF_DONE;
    if (SPEC_BEAM != BEAM_NONE) {
        packet_beams(mode, t_min, root8, eye);
    } else {
        make_box_rays(mode);
        if (SPEC_INSTANCED != 0u)
            packet_instances(mode, t_min, root8);
        else
            packet_mesh(mode, t_min, root8);
    }
    EACH_RAY {
        packet_hits[r].status |= packet_status;
        if (packet_hits[r].primitive == HIT_NONE)
            packet_hits[r].t = make_hit(packet_t_max[r]).t;
    }
}

#endif

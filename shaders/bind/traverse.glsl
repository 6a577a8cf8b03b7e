// Traversal with a stack, for every order of children (SPEC_ORDER). It has two nested do-while
// loops, over nodes and over records: on lavapipe an `if` costs both its sides, and only the end of
// a loop branches (docs/performance.md). twin/traverse.c is this file in C.
#ifndef BIND_TRAVERSE_GLSL
#define BIND_TRAVERSE_GLSL

#include "settle.glsl"
#include "quantized.glsl"
#include "deferred.glsl"

// Defined by the kernel: whether a cut-out primitive is solid at a point. `u` and `v` of a sphere are
// its texture coordinates (sphere_uv), here and below.
bool cutout_is_solid(uint instance, uint primitive, float u, float v);

// Defined by the kernel: the optical depth, in units of 1/256 stop, that a filter with
// TRIANGLE_FILTER_DETAIL adds to a shadow ray that hits it from the front or from behind. `way`:
// the distance from there to the filter_end of the ray. `own`: the depth in its record. A surface
// where the ray enters or leaves a medium may add a negative depth; a sum below 0 counts as 0.
ivec3 filter_detail(uint instance, uint primitive, float u, float v, float way, bool front,
                    ivec3 own);

// Defined by the kernel: the t from which absorption along a shadow ray is measured.
float filter_end(vec3 origin, float t_max);

// Whether a hit comes behind the known one (TRAVERSE_NEXT); at NUMERICS_EXACT keys are compared.
bool is_behind(float t, uint instance, uint primitive, uint known_instance, uint known_primitive)
{
    return t > hit_before ||
           (t == hit_before && (instance > known_instance || (instance == known_instance &&
                                                              primitive > known_primitive)));
}

const uint REF_DONE = 0xffffffffu;
const uint REF_ONE_PRIMITIVE = 1u << BVH_COUNT_SHIFT;

// The largest t at which a candidate may still be nearer than the hit so far.
float farthest(Hit hit)
{
    return SPEC_NUMERICS == NUMERICS_EXACT ? hit.hi : hit.t;
}

// The node stack. With SPEC_SHORT_STACK 0 it is node_stack[base..in_memory). A short stack has its
// top entries in registers, and only the outer loop of walk_mesh moves entries between them and
// memory: on lavapipe a store to a private array costs as much as half a box test, even where
// nothing is stored, while registers cost a few selects.
uint node_stack[SPEC_STACK_SIZE];

// Counters of the last traverse(); with SPEC_COUNT only, and then without a short stack, so that
// all refs are in node_stack. node_levels has the level in the tree of each of its entries.
gpu_cost traversal_cost;
uint node_levels[SPEC_STACK_SIZE];

const uint STACK_REGISTERS = 6u;

struct NodeStack {
    uint base, in_memory, in_registers;
    uint level; // of the current ref; with SPEC_COUNT
    uint r0, r1, r2, r3, r4, r5; // r0: top
};

// pop_ref returns this when the registers are empty but memory is not; refill_stack then fetches
// the ref.
const uint REF_PENDING = 0xfffffffeu;

NodeStack make_stack(uint base, uint level)
{
    return NodeStack(base, base, 0u, level, 0u, 0u, 0u, 0u, 0u, 0u);
}

bool is_inner(uint ref)
{
    return ref < REF_ONE_PRIMITIVE;
}

bool is_leaf(uint ref)
{
    return ref - REF_ONE_PRIMITIVE < REF_PENDING - REF_ONE_PRIMITIVE;
}

void push_memory(uint ref, inout NodeStack stack, inout uint status)
{
    if (stack.in_memory < SPEC_STACK_SIZE) {
        node_stack[stack.in_memory] = ref;
        if (SPEC_COUNT != 0u)
            node_levels[stack.in_memory] = stack.level;
        stack.in_memory++;
        if (SPEC_COUNT != 0u)
            traversal_cost.stack = max(traversal_cost.stack, stack.in_memory);
    } else {
        status |= STATUS_NODE_STACK_OVERFLOW;
    }
}

uint pop_memory(inout NodeStack stack)
{
    if (stack.in_memory == stack.base)
        return REF_DONE;
    stack.in_memory--;
    if (SPEC_COUNT != 0u)
        stack.level = node_levels[stack.in_memory];
    return node_stack[stack.in_memory];
}

// Pushes `ref` where `wanted`. A short stack must have room: see has_room.
void push_ref(bool wanted, uint ref, inout NodeStack stack, inout uint status)
{
    if (SPEC_SHORT_STACK == 0u) {
        if (wanted)
            push_memory(ref, stack, status);
        return;
    }
    stack.r5 = wanted ? stack.r4 : stack.r5;
    stack.r4 = wanted ? stack.r3 : stack.r4;
    stack.r3 = wanted ? stack.r2 : stack.r3;
    stack.r2 = wanted ? stack.r1 : stack.r2;
    stack.r1 = wanted ? stack.r0 : stack.r1;
    stack.r0 = wanted ? ref : stack.r0;
    stack.in_registers += wanted ? 1u : 0u;
}

// Pops a ref; `ref` itself where not `wanted`.
uint pop_ref(bool wanted, uint ref, inout NodeStack stack)
{
    if (SPEC_SHORT_STACK == 0u) {
        if (wanted)
            ref = pop_memory(stack);
        return ref;
    }
    bool some = stack.in_registers != 0u;
    uint top = some ? stack.r0 : stack.in_memory == stack.base ? REF_DONE : REF_PENDING;
    bool shift = wanted && some;
    stack.r0 = shift ? stack.r1 : stack.r0;
    stack.r1 = shift ? stack.r2 : stack.r1;
    stack.r2 = shift ? stack.r3 : stack.r2;
    stack.r3 = shift ? stack.r4 : stack.r3;
    stack.r4 = shift ? stack.r5 : stack.r4;
    stack.in_registers -= shift ? 1u : 0u;
    return wanted ? top : ref;
}

bool has_room(NodeStack stack)
{
    return SPEC_SHORT_STACK == 0u || stack.in_registers < STACK_REGISTERS;
}

// Makes room in full registers, and completes a pop that gave REF_PENDING.
uint refill_stack(uint ref, inout NodeStack stack, inout uint status)
{
    if (SPEC_SHORT_STACK == 0u)
        return ref;
    if (stack.in_registers == STACK_REGISTERS) {
        push_memory(stack.r5, stack, status);
        stack.in_registers--;
    }
    if (ref == REF_PENDING)
        ref = pop_memory(stack);
    return ref;
}

// The near t of a box is made smaller by this share in the tree over instances, whose rays are
// transformed below: room for the float error of the transform, relative to t. Mesh trees use 0:
// their boxes and triangles are tested with the same ray. NUMERICS_EXACT compares boxes with exact t,
// and makes the near t smaller by NEAR_STEPS floats in all trees. That is as much or more, also
// among denormals, whose errors are not relative, and for a t that was rounded to infinity.
const float NEAR_SHARE = 1.0 / 524288.0;
const int NEAR_STEPS = 32;

// Whether the ray is in a box from `near` to `far` before it hits what it has hit so far.
bool enters(float near, float far, float share, Hit hit)
{
    if (SPEC_NUMERICS == NUMERICS_EXACT) {
        // `near` is at least the float with the bits NEAR_STEPS, a denormal: see step_siblings.
        // Devices that are no CPU may have flushed it to 0.
        int bits = floatBitsToInt(near) - NEAR_STEPS;
        near = intBitsToFloat(SPEC_INTERLEAVE != 0u ? bits : max(bits, 0));
    }
    if (SPEC_NUMERICS == NUMERICS_WATERTIGHT && share != 0.0) {
        precise float lower = near - abs(near) * share;
        near = lower;
    }
    return near <= far && near <= farthest(hit);
}

// Whether the ray reaches the second node of a pair first, by the axis `bits` in the first node's
// count.
bool second_first(RaySetup ray, uint bits)
{
    uint axis = (bits >> BVH_AXIS_SHIFT) & BVH_AXIS_MASK;
    bool down = axis == 0u ? ray.negative.x : axis == 1u ? ray.negative.y : ray.negative.z;
    return down != ((bits & BVH_SECOND_LOW) != 0u);
}

// The children of a node: their refs, which of them the ray enters, and whether it should visit the
// second one first.
struct Siblings {
    uint ref_a, ref_b;
    bool hit_a, hit_b, b_wanted;
};

Siblings meet_quantized_siblings(RaySetup ray, uint pair)
{
    uvec4 a = texelFetch(quantized_texels, int(pair)), b = texelFetch(quantized_texels, int(pair + 1u));
    ivec2 in_a = enter_quantized_box(ray, a.xyz), in_b = enter_quantized_box(ray, b.xyz);
    return Siblings(a.w, b.w, in_a.x <= in_a.y, in_b.x <= in_b.y, in_b.x < in_a.x);
}

// Tests both nodes of `pair`. With SPEC_CLIPPED boxes of mesh trees are widened by the ray's margin.
Siblings meet_siblings(RaySetup ray, float t_min, float near_share, uint pair, Hit hit)
{
    uvec4 a0 = fetch_node_row(pair * 2u);
    uvec4 a1 = fetch_node_row(pair * 2u + 1u);
    uvec4 b0 = fetch_node_row(pair * 2u + 2u);
    uvec4 b1 = fetch_node_row(pair * 2u + 3u);
    precise vec3 a_lo = row_vec3(a0) - ray.above;
    precise vec3 a_hi = row_vec3(a1) - ray.below;
    precise vec3 b_lo = row_vec3(b0) - ray.above;
    precise vec3 b_hi = row_vec3(b1) - ray.below;
    float a_near, a_far, b_near, b_far;
    if (SPEC_NUMERICS == NUMERICS_EXACT) // for enters(); NaN stays
        t_min = t_min < intBitsToFloat(NEAR_STEPS) ? intBitsToFloat(NEAR_STEPS) : t_min;
    slab_interval(ray, a_lo, a_hi, t_min, a_near, a_far);
    slab_interval(ray, b_lo, b_hi, t_min, b_near, b_far);
    Siblings s;
    s.hit_a = enters(a_near, a_far, near_share, hit);
    s.hit_b = enters(b_near, b_far, near_share, hit);
    s.ref_a = (a1.w << BVH_COUNT_SHIFT) | a0.w;
    s.ref_b = (b1.w << BVH_COUNT_SHIFT) | b0.w;
    s.b_wanted = false;
    if (SPEC_ORDER == ORDER_DISTANCE)
        s.b_wanted = b_near < a_near;
    if (SPEC_ORDER == ORDER_SIGN)
        s.b_wanted = second_first(ray, a1.w);
    return s;
}

// One step down: tests both nodes of `pair`, returns the one to visit first, and pushes the other.
// `skip`: a ref that is not entered; REF_DONE: none.
uint step_siblings(RaySetup ray, float t_min, float near_share, uint pair, uint skip,
                   inout NodeStack stack, inout Hit hit)
{
    Siblings s;
    if (SPEC_QUANTIZED != 0u)
        s = meet_quantized_siblings(ray, pair);
    else
        s = meet_siblings(ray, t_min, near_share, pair, hit);
    if (SPEC_COUNT != 0u) {
        stack.level++;
        traversal_cost.inner_nodes++;
        traversal_cost.depth = max(traversal_cost.depth, stack.level);
    }
    s.hit_a = s.hit_a && (skip == REF_DONE || s.ref_a != skip);
    s.hit_b = s.hit_b && (skip == REF_DONE || s.ref_b != skip);
    bool b_first = s.hit_b && (!s.hit_a || s.b_wanted);
    push_ref(s.hit_a && s.hit_b, b_first ? s.ref_a : s.ref_b, stack, hit.status);
    return pop_ref(!s.hit_a && !s.hit_b, b_first ? s.ref_b : s.ref_a, stack);
}

// Whether filters can be added without a closer look: their depth follows from the record, or from
// it and the distance.
bool filters_in_passing()
{
    return SPEC_FILTER_DETAIL != FILTERS_PATTERNED && SPEC_CUTOUTS == 0u && !has_integers();
}

bool looks_at_filters(const uint mode)
{
    return mode == TRAVERSE_SHADOW && SPEC_FILTERS != 0u && !filters_in_passing();
}

// Whether rays may pass through the near end of a sphere that has no flag for it.
bool goes_through(const uint mode)
{
    return SPEC_CUTOUTS != 0u || looks_at_filters(mode) ||
           mode == TRAVERSE_NEXT || (mode == TRAVERSE_CLOSEST && SPEC_CULLING != 0u);
}

// Whether a candidate is hit, and nearer than the hit so far, or as near with smaller ids. At
// NUMERICS_EXACT: whether that is possible, unless both keys are known.
bool is_nearer(Candidate m, uint instance, uint primitive, Hit hit)
{
    if (has_bounds_alone())
        return m.met && !(m.lo > hit.hi);
    float t = SPEC_NUMERICS == NUMERICS_EXACT ? m.lo : m.t;
    return m.met && (t < farthest(hit) ||
                     (t == farthest(hit) && (instance < hit.instance ||
                                       (instance == hit.instance && primitive < hit.primitive))));
}

// Whether a candidate is hit, is nearer than the hit so far, and can be hit by rays of this kind at
// all.
bool is_reached(const uint mode, Candidate m, uint flags, uint instance, uint primitive,
                uint skip_instance, uint skip_primitive, Hit hit)
{
    bool reached = is_nearer(m, instance, primitive, hit);
    if (mode == TRAVERSE_NEXT)
        reached = reached && (has_bounds_alone()
                                  ? !(m.hi < hit_before)
                                  : is_behind(SPEC_NUMERICS == NUMERICS_EXACT ? m.hi : m.t, instance,
                                              primitive, skip_instance, skip_primitive));
    if (mode == TRAVERSE_SHADOW)
        reached = reached && (flags & TRIANGLE_NO_SHADOW) == 0u;
    // One-sided surfaces are culled for closest hits alone: they stop light from behind too.
    if (finds_closest(mode) && SPEC_CULLING != 0u)
        reached = reached && (m.front || (flags & TRIANGLE_ONE_SIDED) == 0u);
    return reached;
}

void add_filter(Candidate m, vec2 uv, uint flags, uint shadow, uint instance, uint primitive,
                inout Hit hit)
{
    ivec3 depth = (ivec3(shadow, shadow >> 10, shadow >> 20) & 1023) * FILTER_DEPTH_OF_RECORD;
    if (SPEC_FILTER_DETAIL != FILTERS_PLAIN && (flags & TRIANGLE_FILTER_DETAIL) != 0u)
        depth = filter_detail(instance, primitive, uv.x, uv.y, hit.filter_end - m.t, m.front,
                              depth);
    if (m.owned) // an edge that two triangles share counts once
        hit.filter_depth += depth;
}

// Whether a candidate becomes the hit: it is reached, and not cut out there. Filters add their
// depth and are no hits. `uv`: where textures are read. `refused`: the ray goes on through the
// point.
bool accept_candidate(const uint mode, Candidate m, vec2 uv, uint flags, uint shadow, uint instance,
                    uint primitive, uint skip_instance, uint skip_primitive, inout Hit hit,
                    out bool refused)
{
    bool accepted = is_reached(mode, m, flags, instance, primitive, skip_instance, skip_primitive,
                               hit);
    if (SPEC_CUTOUTS != 0u && accepted && (flags & TRIANGLE_CUTOUT) != 0u)
        accepted = cutout_is_solid(instance, primitive, uv.x, uv.y);
    if (mode == TRAVERSE_SHADOW && SPEC_FILTERS != 0u && accepted &&
        (flags & TRIANGLE_FILTER) != 0u) {
        add_filter(m, uv, flags, shadow, instance, primitive, hit);
        accepted = false;
    }
    refused = is_nearer(m, instance, primitive, hit) && !accepted;
    return accepted;
}

void keep_hit(Candidate m, bool at_exit, uint record, Primitive p, inout Hit hit)
{
    hit.at_exit = at_exit;
    hit.t = m.t;
    hit.lo = m.lo;
    hit.hi = m.hi;
    hit.u = m.u;
    hit.v = m.v;
    hit.triangle = record;
    hit.glass = (p.flags & TRIANGLE_GLASS) != 0u;
    hit.primitive = p.index;
    hit.instance = p.instance;
}

// NUMERICS_EXACT: whether floats leave open if the candidate is hit, or which of the two hits comes
// first.
bool is_unsure(const uint mode, Candidate m, Hit hit)
{
    // A ray for which any hit will do ends at its first one. Until then its lo and hi are equal.
    float nearest = finds_closest(mode) ? hit.lo : hit.hi;
    return !m.sure || !(m.hi < nearest) || (mode == TRAVERSE_NEXT && !(m.lo > hit_before));
}

// Whether some records may need look_at_record before they count.
bool settles(const uint mode)
{
    return has_integers() || SPEC_CUTOUTS != 0u ||
           looks_at_filters(mode) ||
           (SPEC_SPHERES != SPHERES_NONE && goes_through(mode));
}

// Whether a ray ends here: it needs no nearer hit than the one it has `accepted`, or it is deferred.
bool is_over(const uint mode, bool accepted, Hit hit)
{
    return (accepted && !finds_closest(mode)) || must_wait(hit.status);
}

// NUMERICS_EXACT without SPEC_SETTLES: defers the ray and returns true where floats leave a
// candidate undecided.
bool leaves_open(const uint mode, bool reached, Candidate m, inout Hit hit)
{
    bool open = SPEC_NUMERICS == NUMERICS_EXACT && SPEC_SETTLES == 0u && reached &&
                is_unsure(mode, m, hit);
    hit.status |= open ? STATUS_RAY_DEFERRED : 0u;
    return open;
}

// Adds the depth of a filter that is hit, at both ends of a sphere. False: the primitive is no
// filter.
bool pass_filter(RaySetup ray, float t_min, Primitive p, Chord chord, bool at_exit, Candidate m,
                 inout Hit hit)
{
    if ((p.flags & TRIANGLE_FILTER) == 0u)
        return false;
    add_filter(m, vec2(0.0), p.flags, p.r2.w, p.instance, p.index, hit);
    if (SPEC_SPHERES != SPHERES_NONE && p.is_sphere && !at_exit) {
        Candidate far = meet_sphere(ray, chord, t_min, true, p.self);
        bool reached = is_reached(TRAVERSE_SHADOW, far, p.flags, p.instance, p.index, HIT_NONE,
                                  HIT_NONE, hit);
        if (reached && !leaves_open(TRAVERSE_SHADOW, reached, far, hit))
            add_filter(far, vec2(0.0), p.flags, p.r2.w, p.instance, p.index, hit);
    }
    return true;
}

// Tests one record and makes it the hit if it is nearer, or as near with smaller ids. True: the
// traversal may end. `deferred`: it is hit, but look_at_record has to be called for it first.
bool test_rows(const uint mode, RaySetup ray, float t_min, uint record, RecordRows rows,
               uint instance, uint skip_instance, uint skip_primitive, inout Hit hit,
               out bool deferred)
{
    if (SPEC_COUNT != 0u)
        traversal_cost.triangles++;
    Primitive p = make_primitive(mode, rows, instance, skip_instance, skip_primitive);
    Chord chord = chord_of(ray, t_min, p);
    bool at_exit = starts_at_exit(mode, p, chord, t_min);
    Candidate m = meet_primitive(ray, t_min, p, chord, at_exit);
    bool accepted = is_reached(mode, m, p.flags, p.instance, p.index, skip_instance,
                               skip_primitive, hit);
    deferred = false;
    if (settles(mode)) {
        bool marked = (SPEC_CUTOUTS != 0u && (p.flags & TRIANGLE_CUTOUT) != 0u) ||
                      (looks_at_filters(mode) && (p.flags & TRIANGLE_FILTER) != 0u);
        deferred = accepted && marked;
        if (SPEC_SPHERES != SPHERES_NONE && goes_through(mode))
            deferred = deferred || (p.is_sphere && chord.met);
        if (has_integers())
            deferred = deferred || (accepted && is_unsure(mode, m, hit));
        accepted = accepted && !deferred;
    }
    bool open = leaves_open(mode, accepted, m, hit);
    accepted = accepted && !open;
    if (mode == TRAVERSE_SHADOW && SPEC_FILTERS != 0u && filters_in_passing() && accepted)
        accepted = !pass_filter(ray, t_min, p, chord, at_exit, m, hit);
    if (accepted)
        keep_hit(m, at_exit, record, p, hit);
    if (SPEC_FILTERS != 0u)
        open = must_wait(hit.status); // pass_filter() may have deferred it
    return open || (!finds_closest(mode) && accepted);
}

bool test_record(const uint mode, RaySetup ray, float t_min, uint record, uint instance,
                 uint skip_instance, uint skip_primitive, inout Hit hit, out bool deferred)
{
    return test_rows(mode, ray, t_min, record, fetch_record(record), instance, skip_instance,
                     skip_primitive, hit, deferred);
}

// Whether a loop has another iteration; in a packet the same for all lanes, since lavapipe 22.3
// added a filter twice in lanes that had left the loop before others.
bool goes_on(bool again)
{
    return another_iteration(SPEC_PACKETS != 0u ? any_lane(again) : again);
}

// Tests a record whose test was deferred, including all that may let the ray through: cut-outs,
// filters, and the far end of a sphere whose near end lets it through. `origin`, `dir`: the ray in
// world space.
bool look_at_rows(const uint mode, RaySetup ray, vec3 origin, vec3 dir, float t_min, uint record,
                  RecordRows rows, uint instance, uint skip_instance, uint skip_primitive,
                  inout Hit hit)
{
    Primitive p = make_primitive(mode, rows, instance, skip_instance, skip_primitive);
    Chord chord = chord_of(ray, t_min, p);
    bool at_exit = starts_at_exit(mode, p, chord, t_min);
    bool accepted = false, again = true;
    do {
        bool lane_turn = again;
        again = false;
        Candidate m = meet_primitive(ray, t_min, p, chord, at_exit);
        bool open = SPEC_NUMERICS == NUMERICS_EXACT &&
                    is_reached(mode, m, p.flags, p.instance, p.index, skip_instance,
                               skip_primitive, hit) && is_unsure(mode, m, hit);
        if (has_integers() && open)
            settle(ray, origin, dir, t_min, record, p, at_exit, m, hit);
        if (SPEC_SETTLES == 0u && open)
            hit.status |= STATUS_RAY_DEFERRED;
        if (SPEC_SETTLES == 0u && open)
            break;
        vec2 uv = vec2(m.u, m.v);
        if (SPEC_SPHERES != SPHERES_NONE && (SPEC_CUTOUTS != 0u || SPEC_FILTER_DETAIL != 0u) &&
            p.is_sphere)
            uv = sphere_uv(dir_from_square(uv));
        bool refused;
        if (lane_turn) {
            accepted = accept_candidate(mode, m, uv, p.flags, p.r2.w, p.instance, p.index,
                                      skip_instance, skip_primitive, hit, refused);
            if (accepted)
                keep_hit(m, at_exit, record, p, hit);
            again = p.is_sphere && goes_through(mode) && refused && !at_exit;
        }
        at_exit = true;
    } while (goes_on(again));
    if (again) // the driver has cut the loop short
        hit.status |= STATUS_UNFINISHED_TRAVERSAL;
    return is_over(mode, accepted, hit);
}

bool look_at_record(const uint mode, RaySetup ray, vec3 origin, vec3 dir, float t_min, uint record,
                    uint instance, uint skip_instance, uint skip_primitive, inout Hit hit)
{
    return look_at_rows(mode, ray, origin, dir, t_min, record, fetch_record(record), instance,
                        skip_instance, skip_primitive, hit);
}

// The ref to visit after the record of a leaf at `ref` has been tested.
uint next_ref(uint ref, bool done, inout NodeStack stack)
{
    ref += 1u - REF_ONE_PRIMITIVE;
    if (SPEC_COUNT != 0u && (is_inner(ref) || done))
        traversal_cost.leaves++;
    ref = pop_ref(is_inner(ref), ref, stack);
    return done ? REF_DONE : ref;
}

// Traverses a mesh tree from `ref` on until REF_DONE, or until the record at `ref` is `deferred`.
void walk_mesh(const uint mode, RaySetup ray, float t_min, uint instance, uint skip_instance,
               uint skip_primitive, inout uint ref, inout NodeStack stack, inout Hit hit,
               out bool deferred)
{
    deferred = false;
    do {
        if (SPEC_QUANTIZED != 0u)
            quantized_ray.end = floatBitsToInt(quantized_distance(farthest(hit)));
        do {
            if (is_inner(ref) && has_room(stack))
                ref = step_siblings(ray, t_min, 0.0, ref, REF_DONE, stack, hit);
        } while (is_inner(ref) && has_room(stack));
        do {
            if (is_leaf(ref)) {
                bool done = test_record(mode, ray, t_min, ref & BVH_FIRST_MASK, instance,
                                        skip_instance, skip_primitive, hit, deferred);
                if (!deferred)
                    ref = next_ref(ref, done, stack);
            }
        } while (is_leaf(ref) && !deferred);
        ref = refill_stack(ref, stack, hit.status);
    } while (another_iteration(ref != REF_DONE && !deferred));
    // A driver that cuts loops short (lavapipe: after 65,535 iterations per subgroup) leaves work
    // undone.
    if (ref != REF_DONE && !deferred)
        hit.status |= STATUS_UNFINISHED_TRAVERSAL;
}

// Calls look_at_record for the record at `ref`, and goes on to the next ref.
void look_at_leaf(const uint mode, RaySetup ray, vec3 origin, vec3 dir, float t_min, uint instance,
                  uint skip_instance, uint skip_primitive, inout uint ref, inout NodeStack stack,
                  inout Hit hit)
{
    bool done = look_at_record(mode, ray, origin, dir, t_min, ref & BVH_FIRST_MASK, instance,
                               skip_instance, skip_primitive, hit);
    ref = next_ref(ref, done, stack);
    ref = refill_stack(ref, stack, hit.status);
}

// Traverses the only mesh tree. A ray with a deferred record waits until all others of its subgroup
// are done or have one too: look_at_record costs more than many tests, and on lavapipe it costs
// that wherever it stands, needed or not.
void traverse_mesh(const uint mode, RaySetup ray, float t_min, uint root, uint skip_instance,
                   uint skip_primitive, inout Hit hit)
{
    NodeStack stack = make_stack(0u, 0u);
    uint ref = root;
    if (SPEC_QUANTIZED != 0u)
        make_quantized_ray(ray, t_min);
    do {
        bool deferred;
        walk_mesh(mode, ray, t_min, 0u, skip_instance, skip_primitive, ref, stack, hit, deferred);
        if (settles(mode) && deferred)
            look_at_leaf(mode, ray, ray.origin, ray.dir, t_min, 0u, skip_instance, skip_primitive,
                         ref, stack, hit);
    } while (settles(mode) && another_iteration(ref != REF_DONE));
    if (ref != REF_DONE)
        hit.status |= STATUS_UNFINISHED_TRAVERSAL;
}

// Transforms a ray to an instance's object space, ready for its mesh tree.
RaySetup make_local_setup(uint instance, vec3 origin, vec3 dir)
{
    InstanceFrame frame = fetch_instance_frame(instance);
    RaySetup local = make_ray_setup(to_object_point(frame, origin), to_object_dir(frame, dir));
    if (SPEC_CLIPPED != 0u)
        widen_ray_setup(local, fetch_mesh_center(instance), fetch_mesh_reach(instance));
    return local;
}

// Goes on through the tree over instances at `ref`, whose leaves hold one instance each, until
// REF_DONE or until a record is deferred. `inside`: it first finishes the mesh tree of that leaf,
// at `mesh_ref`. `skip`: the leaf that the ray need not enter.
void walk_instances(const uint mode, RaySetup ray, vec3 origin, vec3 dir, float t_min,
                    uint skip_instance, uint skip_primitive, uint skip, inout uint ref,
                    inout NodeStack stack, inout RaySetup local, inout uint mesh_ref,
                    inout NodeStack mesh_stack, bool inside, inout Hit hit, out bool deferred)
{
    deferred = false;
    do {
        do {
            if (is_inner(ref) && has_room(stack) && !inside)
                ref = step_siblings(ray, t_min, NEAR_SHARE, ref, skip, stack, hit);
        } while (is_inner(ref) && has_room(stack) && !inside);
        if (is_leaf(ref)) {
            uint instance = ref & BVH_FIRST_MASK;
            if (!inside) {
                local = make_local_setup(instance, origin, dir);
                mesh_ref = fetch_instance_row(instance * INSTANCE_ROWS + 3u).x;
                mesh_stack = make_stack(stack.in_memory, stack.level);
                if (SPEC_COUNT != 0u)
                    traversal_cost.instances++;
            }
            walk_mesh(mode, local, t_min, instance, skip_instance, skip_primitive, mesh_ref,
                      mesh_stack, hit, deferred);
            bool done = is_over(mode, hit.primitive != HIT_NONE, hit);
            if (!deferred)
                ref = done ? REF_DONE : pop_ref(true, ref, stack);
            inside = false;
        }
        ref = refill_stack(ref, stack, hit.status);
    } while (another_iteration(ref != REF_DONE && !deferred));
    if (ref != REF_DONE && !deferred)
        hit.status |= STATUS_UNFINISHED_TRAVERSAL;
}

// Traverses the tree over instances, with deferred records as in traverse_mesh.
void traverse_instances(const uint mode, vec3 origin, vec3 dir, float t_min, uint root,
                        uint skip_instance, uint skip_primitive, inout Hit hit)
{
    RaySetup ray = make_ray_setup(origin, dir), local = ray;
    vec3 own, others;
    fetch_slack(own, others);
    widen_world_setup(ray, own, others);
    NodeStack stack = make_stack(0u, 0u), mesh_stack = stack;
    uint skip = skip_primitive == SKIP_ALL ? REF_ONE_PRIMITIVE | skip_instance : REF_DONE;
    uint ref = root == skip ? REF_DONE : root, mesh_ref = REF_DONE;
    bool inside = false;
    do {
        bool deferred;
        walk_instances(mode, ray, origin, dir, t_min, skip_instance, skip_primitive, skip, ref,
                       stack, local, mesh_ref, mesh_stack, inside, hit, deferred);
        inside = settles(mode); // the rays that wait are in a mesh tree
        if (settles(mode) && deferred)
            look_at_leaf(mode, local, origin, dir, t_min, ref & BVH_FIRST_MASK, skip_instance,
                         skip_primitive, mesh_ref, mesh_stack, hit);
    } while (settles(mode) && another_iteration(ref != REF_DONE));
    if (ref != REF_DONE)
        hit.status |= STATUS_UNFINISHED_TRAVERSAL;
}

bool is_usable(vec3 origin, vec3 dir)
{
    precise vec3 bounded = (origin - origin) + (dir - dir); // 0, or NaN
    return bounded.x + bounded.y + bounded.z == 0.0 && dir != vec3(0.0);
}

// Finds a hit with t_min <= t <= t_max. Primitive `skip_primitive` of instance `skip_instance`,
// where the ray starts, does not count, nor does any of it with SKIP_ALL; but a sphere is hit again,
// at its far side, by a ray that goes inwards. Equal t goes to the smaller instance, then primitive.
// `root`: a ref of the instance tree, or without SPEC_INSTANCED of the only mesh tree (with
// SPEC_FLAT, that of the whole scene). Rays that are not finite hit nothing.
Hit traverse(const uint mode, vec3 origin, vec3 dir, float t_min, float t_max, uint root,
             uint skip_instance, uint skip_primitive)
{
    Hit hit = make_hit(t_max);
    if (mode == TRAVERSE_SHADOW)
        hit.filter_end = filter_end(origin, t_max);
    if (SPEC_COUNT != 0u)
        traversal_cost = gpu_cost(1u, 0u, 0u, 0u, 0u, 0u, 0u, 0u);
    if (!is_usable(origin, dir))
        root = REF_DONE;
    if (SPEC_NUMERICS == NUMERICS_EXACT && t_min < 0.0) // nothing is hit behind the origin
        t_min = 0.0;
    if (SPEC_INSTANCED != 0u) {
        traverse_instances(mode, origin, dir, t_min, root, skip_instance, skip_primitive, hit);
    } else {
        RaySetup ray = make_ray_setup(origin, dir);
        if (SPEC_CLIPPED != 0u)
            widen_ray_setup(ray, fetch_mesh_center(0u), fetch_mesh_reach(0u));
        traverse_mesh(mode, ray, t_min, root, skip_instance, skip_primitive, hit);
    }
    return hit;
}

#endif

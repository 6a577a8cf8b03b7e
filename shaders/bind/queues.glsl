// The queues between the stages of a picture: rays, hits, sums (abi/queues.h). Stages write them as
// storage buffers; later dispatches read them as texel buffers where SPEC_LOAD_PATH says so.
#ifndef BIND_QUEUES_GLSL
#define BIND_QUEUES_GLSL

#include "../abi/queues.h"
#include "camera.glsl"
#include "../lib/wide.glsl"
#include "packet_rays.glsl"

layout(set = 0, binding = BIND_GENERATIONS, std430) buffer GenerationBuffer
{
    gpu_tally tally;
    gpu_generation generations[];
};
layout(set = 0, binding = BIND_GENERATION_TEXELS) uniform usamplerBuffer generation_texels;
layout(set = 0, binding = BIND_RAY_ROWS, std430) buffer RayRowBuffer { uvec4 ray_rows[]; };
layout(set = 0, binding = BIND_RAY_ROWS, std430) buffer WideRayBuffer { u64vec4 wide_rays[]; };
layout(set = 0, binding = BIND_RAY_TEXELS) uniform usamplerBuffer ray_texels;
layout(set = 0, binding = BIND_HIT_ROWS, std430) buffer HitRowBuffer { uvec4 hit_rows[]; };
layout(set = 0, binding = BIND_HIT_ROWS, std430) buffer WideHitBuffer { u64vec2 wide_hits[]; };
layout(set = 0, binding = BIND_HIT_TEXELS) uniform usamplerBuffer hit_texels;
layout(set = 0, binding = BIND_SUM_TEXELS) uniform usamplerBuffer sum_texels;
layout(set = 0, binding = BIND_SUMS, std430) buffer SumBuffer
{
    vec4 sums[]; // of each ray: the weighted radiance that it brings; in w SUM_*
};
layout(set = 0, binding = BIND_SUMS, std430) buffer WideSumBuffer { u64vec2 wide_sums[]; };
layout(set = 0, binding = BIND_HIT_LIST, std430) buffer HitListBuffer { uint hit_list[]; };
layout(set = 0, binding = BIND_LIST_TEXELS) uniform usamplerBuffer list_texels;
layout(set = 0, binding = BIND_CUT_SUMS, std430) buffer CutSumBuffer
{
    // Weights of the cut rays of each pixel (without SPEC_PIXEL_DATA: slot of the tile), for --depth and
    // --bailout, over all samples so far.
    vec2 cut_sums[];
};
layout(set = 0, binding = BIND_CUTS, std430) buffer CutBuffer
{
    uint cuts[]; // two for each slot: weights of rays cut by --depth and by --bailout, in 1 /
                 // CUT_PARTS
};
layout(set = 0, binding = BIND_CUT_TEXELS) uniform usamplerBuffer cut_texels;
layout(set = 0, binding = BIND_AOVS, std430) buffer AovBuffer
{
    vec4 aovs[]; // SPEC_AOVS for each slot, of the current sample; behind all slots SPEC_AOVS for
                 // each pixel, of all samples so far
};
layout(set = 0, binding = BIND_SHAPE_SHADOWS, std430) buffer ShapeShadowBuffer { uint shape_shadows[]; };
layout(set = 0, binding = BIND_RAY_KINDS, std430) buffer RayKindBuffer
{
    uint ray_kinds[]; // RAY_* in the low bits (with SPEC_COUNT or SPEC_PROBE), ray.way above
};

// Whether rays have a word in ray_kinds.
const bool HAS_KINDS = SPEC_COUNT != 0u || SPEC_PROBE != 0u || SPEC_MINIFICATION != 0u;
const uint KIND_BITS = 3u;

// Whether surfaces call for rays, traced or not.
const bool CALLS_RAYS = SPEC_REFLECTION != 0u || SPEC_REFRACTION != 0u || SPEC_CUTOUTS != 0u ||
                        SPEC_CATCHERS != 0u;

// Weights of cut rays are summed as integers, in units of 1 / CUT_PARTS, so that the order of
// summation does not matter.
const float CUT_PARTS = 16777216.0;

uvec4 fetch_ray_row(uint row)
{
    if (SPEC_LOAD_PATH == LOAD_TEXEL)
        return texelFetch(ray_texels, int(row));
    return ray_rows[row];
}

uvec4 fetch_hit_row(uint row)
{
    if (SPEC_LOAD_PATH == LOAD_TEXEL)
        return texelFetch(hit_texels, int(row));
    return hit_rows[row];
}

vec4 fetch_sum(uint id)
{
    if (SPEC_LOAD_PATH == LOAD_TEXEL)
        return uintBitsToFloat(texelFetch(sum_texels, int(id)));
    return sums[id];
}

// The weights of a slot's cut rays.
vec2 fetch_cuts(uint slot)
{
    uvec2 own = uvec2(0u);
    if (SPEC_LOAD_PATH == LOAD_TEXEL) {
        uvec4 pair = texelFetch(cut_texels, int(slot >> 1));
        own = (slot & 1u) != 0u ? pair.zw : pair.xy;
    } else {
        own = uvec2(cuts[slot * 2u], cuts[slot * 2u + 1u]);
    }
    return vec2(own) / CUT_PARTS;
}

// Ids of the refracted, the straight and the reflected ray that sums[].w names; HIT_NONE where
// there is none.
uvec3 child_ids(uint has)
{
    bvec3 some = notEqual(uvec3(has) & uvec3(SUM_REFRACTED, SUM_STRAIGHT, SUM_REFLECTED), uvec3(0u));
    uvec3 place = uvec3(0u, uint(some.x), uint(some.x) + uint(some.y));
    return mix(uvec3(HIT_NONE), (has & SUM_ID_MASK) + place, some);
}

// Whether hits keep the bounds of their keys: for surfaces in contact, whose order along the ray
// depends on them.
const bool HIT_HAS_KEY = SPEC_NUMERICS == NUMERICS_EXACT && SPEC_MEDIA == MEDIA_TOUCH;

// Number of rows of a hit. The second row holds the instance, which a record of a flat tree names
// itself, and the bounds of the key.
const uint HIT_ROWS = HIT_HAS_KEY || SPEC_INSTANCED != 0u ? 2u : 1u;

// Instance and primitive of a record; with RECORD_SKIPS_ALL, SKIP_ALL for the primitive. `instance`:
// the hit's, used with SPEC_INSTANCED.
uvec2 fetch_record_ids(uint record, uint instance)
{
    bool all = SPEC_INSTANCED != 0u && (record & RECORD_SKIPS_ALL) != 0u;
    record = all ? record & ~RECORD_SKIPS_ALL : record;
    bool on_shape = (SPEC_HOOKS & HOOK_INTERSECT) != 0u && record == HIT_SHAPE; // the shape has no record
    uint row = (on_shape ? 0u : record) * TRIANGLE_ROWS;
    if (SPEC_FLAT != 0u)
        instance = fetch_triangle_row(row + 1u).w >> TRIANGLE_INSTANCE_SHIFT;
    uvec2 ids = uvec2(SPEC_INSTANCED != 0u || SPEC_FLAT != 0u ? instance : 0u, fetch_triangle_row(row).w);
    ids.y = all ? SKIP_ALL : ids.y;
    return on_shape ? uvec2(HIT_SHAPE, 0u) : ids;
}

// The word of `item` in its row, which holds those of four items.
uint word_of_row(uvec4 row, uint item)
{
    uvec2 pair = (item & 2u) != 0u ? row.zw : row.xy;
    return (item & 1u) != 0u ? pair.y : pair.x;
}

// Whether a queue of the tile is full: then the rest of its work is skipped, and the tile is drawn
// again in smaller ones.
bool is_queue_full()
{
    return (status_word & STATUS_QUEUE_FULL) != 0u;
}

// The number of camera rays. Their ids are the slots of their pixels.
uint camera_ray_count()
{
    uint slots = chunk.block_count * BLOCK_PIXELS;
    return is_listed() ? min(slots, chunk.listed - chunk.first_block * BLOCK_PIXELS) : slots;
}

// The first id of the back segment; ids of the front segment are below it. Camera rays are all in
// front.
uint middle_id()
{
    return SPEC_SEGMENTS == 2u ? (chunk.ray_capacity + camera_ray_count()) / 2u
                               : chunk.ray_capacity;
}

// `firsts` of a generation: x and y alone.
uvec2 fetch_firsts(uint generation)
{
    if (SPEC_LOAD_PATH == LOAD_TEXEL) {
        uint row = TALLY_ROWS + generation * GENERATION_ROWS + LISTS_COUNT * ITEMS_ROWS;
        return texelFetch(generation_texels, int(row)).xy;
    }
    return generations[generation].firsts.xy;
}

// The most rays of one generation for which there is room.
uint generation_capacity()
{
    return chunk.ray_capacity / 4u;
}

// The place of a ray in the buffer of rays. Only stages of its own generation read a ray, so even
// generations share one half of the buffer and odd ones the other: a small buffer stays in caches.
uint ray_place(uint id, uint generation)
{
    uvec2 firsts = fetch_firsts(generation);
    bool back = SPEC_SEGMENTS == 2u && id >= middle_id();
    uint at = back ? generation_capacity() - (chunk.ray_capacity - firsts.y - id) : id - firsts.x;
    // An invocation without a ray asks for id 0, which may belong to another generation.
    return min(at, generation_capacity() - 1u) + (generation & 1u) * generation_capacity();
}

Ray queued_ray(uint id, out uint slot)
{
    uint row = ray_place(id, chunk.generation) * RAY_ROWS;
    uvec4 r0 = fetch_ray_row(row), r1 = fetch_ray_row(row + 1u), r2 = fetch_ray_row(row + 2u);
    Ray ray;
    ray.origin = row_vec3(r0);
    ray.dir = row_vec3(r1);
    ray.weight = row_vec3(r2);
    ray.media = SPEC_MEDIA != 0u ? fetch_ray_row(row + 3u) : uvec4(0u);
    ray.steps = r0.w & ((1u << frame.slot_shift) - 1u);
    slot = r0.w >> frame.slot_shift;
    uint kind = HAS_KINDS ? ray_kinds[id] : 0u;
    ray.kind = kind & KIND_BITS;
    ray.way = uintBitsToFloat(kind & ~KIND_BITS);
    ray.skip_record = r1.w;
    uvec2 skip = fetch_record_ids(r1.w, r2.w);
    ray.skip_instance = skip.x;
    ray.skip_primitive = skip.y;
    return ray;
}

// Whether the dispatch works on camera rays.
bool is_primary()
{
    return SPEC_GENERATIONS == 1u || (SPEC_GENERATIONS == 3u && chunk.generation == 0u);
}

Ray fetch_ray(uint id, out uint slot)
{
    bool queued = SPEC_SECONDARY != 0u && !is_primary();
    Ray ray;
    if (SPEC_GENERATIONS != 2u) {
        slot = queued ? 0u : id;
        if (SPEC_VIEWS != 0u)
            load_view(slot);
        ray = camera_ray(slot_pixel(slot));
    }
    if (SPEC_SECONDARY != 0u && queued) {
        ray = queued_ray(id, slot);
        if (SPEC_VIEWS != 0u && SPEC_MINIFICATION != 0u)
            load_view(slot);
    }
    return ray;
}

// Stores a ray of the next generation.
void store_ray(uint id, Ray ray, uint slot)
{
    uint place = ray_place(id, chunk.generation + 1u);
    uvec4 r0 = uvec4(floatBitsToUint(ray.origin), ray.steps | slot << frame.slot_shift);
    uvec4 r1 = uvec4(floatBitsToUint(ray.dir), ray.skip_record);
    uvec4 r2 = uvec4(floatBitsToUint(ray.weight), ray.skip_instance);
    if (SPEC_WIDE_ROWS != 0u) {
        wide_rays[place * 2u] = wide_rows(r0, r1);
        wide_rays[place * 2u + 1u] = wide_rows(r2, ray.media);
    } else {
        ray_rows[place * RAY_ROWS] = r0;
        ray_rows[place * RAY_ROWS + 1u] = r1;
        ray_rows[place * RAY_ROWS + 2u] = r2;
        if (SPEC_MEDIA != 0u)
            ray_rows[place * RAY_ROWS + 3u] = ray.media;
    }
    if (HAS_KINDS)
        ray_kinds[id] = ray.kind | (SPEC_MINIFICATION != 0u ? floatBitsToUint(ray.way) & ~KIND_BITS : 0u);
}

void store_hit_row(uint row, uvec4 value)
{
    if (SPEC_WIDE_ROWS != 0u)
        wide_hits[row] = wide_row(value);
    else
        hit_rows[row] = value;
}

void store_hit(uint id, Hit hit)
{
    uint record = hit.triangle | (HIT_HAS_KEY && hit.at_exit ? HIT_AT_EXIT : 0u);
    store_hit_row(id * HIT_ROWS, uvec4(floatBitsToUint(vec3(hit.t, hit.u, hit.v)), record));
    if (HIT_HAS_KEY)
        store_hit_row(id * HIT_ROWS + 1u,
                      uvec4(hit.instance, floatBitsToUint(hit.lo), floatBitsToUint(hit.hi), 0u));
    else if (HIT_ROWS == 2u)
        hit_rows[id * HIT_ROWS + 1u].x = hit.instance;
}

void store_sum(uint id, vec3 radiance, uint has)
{
    uvec4 row = uvec4(floatBitsToUint(radiance), has);
    if (SPEC_WIDE_ROWS != 0u)
        wide_sums[id] = wide_row(row);
    else
        sums[id] = uintBitsToFloat(row);
}

// The instance and the primitive of a hit.
uvec2 fetch_hit_ids(uint id, uint record)
{
    uint instance = SPEC_INSTANCED != 0u ? fetch_hit_row(id * HIT_ROWS + 1u).x : 0u;
    return fetch_record_ids(record, instance);
}

// Makes a user's shape the hit of a ray. `square`: its normal, by square_from_dir().
void put_shape_in(inout Hit hit, float t, vec2 square)
{
    hit.t = hit.lo = hit.hi = t;
    hit.u = square.x;
    hit.v = square.y;
    hit.triangle = hit.instance = HIT_SHAPE;
    hit.primitive = 0u;
    hit.at_exit = false;
    hit.glass = (frame.shape_material & SHAPE_IS_GLASS) != 0u;
}

// Stores the ray's hit with the user's shape. closest.comp reads it and stores the closer of this
// and the hit in the trees.
void store_shape(uint id, Hit hit)
{
    store_hit_row(id * HIT_ROWS, uvec4(floatBitsToUint(vec3(hit.t, hit.u, hit.v)), hit.triangle));
}

// Replaces the ray's hit in the trees by the stored hit on the user's shape where that is closer.
void add_stored_shape(uint id, inout Hit hit)
{
    uvec4 row = fetch_hit_row(id * HIT_ROWS);
    float t = uintBitsToFloat(row.x);
    if (row.w == HIT_SHAPE && (hit.primitive == HIT_NONE || t < hit.t))
        put_shape_in(hit, t, uintBitsToFloat(row.yz));
}

// Two words for each item of the light's list, at `place`: bit `point` is set where the user's
// shape blocks that point of the light.
void store_shape_shadows(uint place, uint word, uint bits)
{
    shape_shadows[place * 2u + word] = bits;
}

bool is_in_shape_shadow(uint place, uint point)
{
    return (shape_shadows[place * 2u + (point >> 5)] >> (point & 31u) & 1u) != 0u;
}

Hit fetch_hit(uint id)
{
    uvec4 r0 = fetch_hit_row(id * HIT_ROWS);
    Hit hit = make_hit(uintBitsToFloat(r0.x));
    hit.u = uintBitsToFloat(r0.y);
    hit.v = uintBitsToFloat(r0.z);
    hit.triangle = r0.w & ~HIT_AT_EXIT;
    hit.at_exit = HIT_HAS_KEY && (r0.w & HIT_AT_EXIT) != 0u;
    uvec2 own = fetch_hit_ids(id, hit.triangle);
    hit.instance = own.x;
    hit.primitive = own.y;
    if (HIT_HAS_KEY) {
        uvec4 r1 = fetch_hit_row(id * HIT_ROWS + 1u);
        hit.lo = uintBitsToFloat(r1.y);
        hit.hi = uintBitsToFloat(r1.z);
    }
    return hit;
}

// Numbers of items of a list in its front and back segments.
uvec2 fetch_counts(uint generation, uint list)
{
    if (SPEC_LOAD_PATH == LOAD_TEXEL) {
        uint row = TALLY_ROWS + generation * GENERATION_ROWS + list * ITEMS_ROWS + 1u;
        return texelFetch(generation_texels, int(row)).xy;
    }
    gpu_items items = generations[generation].lists[list];
    return uvec2(items.front, items.back);
}

// Whether the last generation that was traced called for no more rays. Where a loop was cut short
// that several lights share, the tile is drawn again. With SPEC_DIRECT, shading may have such loops.
bool is_tile_done()
{
    if ((SPEC_LIGHTS_EACH > 1u || SPEC_DIRECT != 0u) && (status_word & STATUS_UNFINISHED) != 0u)
        return false;
    if (chunk.light == GENERATION_NONE)
        return true;
    uvec2 left = fetch_counts(chunk.light, LIST_RAYS);
    return left.x + left.y == 0u;
}

// The room of the generation's lists of hits. Camera rays get no more than they need: later
// generations list their hits behind.
uint hit_capacity()
{
    return is_primary() ? camera_ray_count() : chunk.ray_capacity;
}

// The place of an item of the dispatch's generation among those of all generations of the tile. In
// lists of rays this is the ray's id.
uint place_in_tile(uint item)
{
    uvec2 firsts = fetch_firsts(chunk.generation);
    return SPEC_SEGMENTS == 2u && item >= middle_id() ? item - firsts.y : item + firsts.x;
}

// The id of the ray at `item` of the list of hits of the dispatch's material class.
uint fetch_listed_hit(uint item)
{
    uint at = (chunk.list - LIST_HITS) * chunk.ray_capacity + place_in_tile(item);
    return SPEC_LOAD_PATH == LOAD_TEXEL ? word_of_row(texelFetch(list_texels, int(at >> 2)), at)
                                        : hit_list[at];
}

const uint ITEM_NONE = 0xffffffffu;

// Whether the invocation takes its items from back segments, and appends to them.
bool is_back = false;

// The item at `place` among the `each` items of the workgroup, in the list that the dispatch works
// on: its place in the front segment or, in the back segment, counted down from `capacity` - 1.
// ITEM_NONE: there is none.
uint listed_item(uint place, uint each, uint capacity)
{
    uint group = gl_WorkGroupID.x;
    uvec2 counts = fetch_counts(chunk.generation, chunk.list);
    uint front_groups = (counts.x + each - 1u) / each;
    is_back = SPEC_SEGMENTS == 2u && group >= front_groups;
    uint at = (group - (is_back ? front_groups : 0u)) * each + place;
    if (is_queue_full() || at >= (is_back ? counts.y : counts.x))
        return ITEM_NONE;
    return is_back ? capacity - 1u - at : at;
}

// The invocation's item `r` of the dispatch's list.
uint invocation_item(uint r, uint capacity)
{
    return listed_item(lane_place(r), SPEC_GROUP_SIZE * SPEC_PACKET_RAYS, capacity);
}

// The invocation's item of the deferred list. is_back is right only where items are ids of rays;
// kernels with other items, such as shadow.comp, append nothing and do not read it.
uint deferred_item(uint r)
{
    if (r == 0u)
        count_deferred();
    uint at = gl_WorkGroupID.x * SPEC_GROUP_SIZE + gl_LocalInvocationID.x;
    uint item = at < deferred.count && r == 0u ? deferred_items[at] : ITEM_NONE;
    is_back = SPEC_SEGMENTS == 2u && item != ITEM_NONE && item >= middle_id();
    return item;
}

// The id of camera ray `r` of the invocation; ITEM_NONE: none.
uint camera_item(uint r)
{
    uint each = SPEC_GROUP_SIZE * SPEC_PACKET_RAYS;
    uint at = invocation_slot() / SPEC_GROUP_SIZE * each + lane_place(r);
    is_back = SPEC_SEGMENTS == 2u && gl_WorkGroupID.x >= (gl_NumWorkGroups.x + 1u) / 2u;
    return !is_queue_full() && at < camera_ray_count() ? at : ITEM_NONE;
}

// The id of ray `r` of the invocation, in a dispatch over all rays of the generation; ITEM_NONE:
// there is none.
uint traced_item(uint r)
{
    if (is_primary())
        return camera_item(r);
    uint item = invocation_item(r, chunk.ray_capacity);
    return item == ITEM_NONE ? ITEM_NONE : place_in_tile(item);
}

// Reserves room for `all` items of the subgroup in a segment of a list; returns the place of the
// first. `back` must be the same in all its invocations.
uint extend_segment(uint generation, uint list, uint all, uint each, bool back)
{
    uint at = 0u;
    if (is_first_lane() && all != 0u) {
        at = back ? atomicAdd(generations[generation].lists[list].back, all)
                  : atomicAdd(generations[generation].lists[list].front, all);
        uint more = (at + all + each - 1u) / each - (at + each - 1u) / each;
        if (more != 0u)
            atomicAdd(generations[generation].lists[list].groups, more);
    }
    return from_first(at);
}

uint append_segment(uint generation, uint list, uint wanted, uint each, bool back)
{
    uint all, before = count_before(wanted, all);
    return extend_segment(generation, list, all, each, back) + before;
}

// Reserves room for `wanted` items of the invocation in a list of a generation; returns the place
// of the first in its segment. `each`: how many items a workgroup over that list takes.
uint append_items(uint generation, uint list, uint wanted, uint each)
{
    if (SPEC_SEGMENTS == 2u && SPEC_NUMERICS == NUMERICS_EXACT && SPEC_SETTLES != 0u) {
        // A dispatch over deferred items has invocations of both segments in one subgroup.
        uint front = append_segment(generation, list, is_back ? 0u : wanted, each, false);
        uint back = append_segment(generation, list, is_back ? wanted : 0u, each, true);
        return is_back ? back : front;
    }
    return append_segment(generation, list, wanted, each, is_back);
}

// The place in a list of `capacity` items of item `at` of the invocation's segment: back segments
// run downwards.
uint item_place(uint at, uint capacity)
{
    return is_back ? capacity - 1u - at : at;
}

// Lists the hits of the invocation's rays, class by class. In each list the subgroup's rays `r`
// come behind its rays `r` - 1.
void list_hits(bool met[SPEC_PACKET_RAYS], uint class_of[SPEC_PACKET_RAYS], uint ids[SPEC_PACKET_RAYS])
{
    uint before[SPEC_PACKET_RAYS];
    [[unroll]] for (uint k = 0u; k < SPEC_CLASSES; k++) {
        uint all = 0u, each = SPEC_LIST_GROUP, list = LIST_HITS + k, first = 0u;
        [[unroll]] for (uint r = 0u; r < SPEC_PACKET_RAYS; r++) {
            uint of_ray;
            before[r] = all + count_before(uint(met[r] && class_of[r] == k), of_ray);
            all += of_ray;
        }
        if (SPEC_PACKET_RAYS == 1u)
            first = append_items(chunk.generation, list, uint(met[0] && class_of[0] == k), each) - before[0];
        else
            first = extend_segment(chunk.generation, list, all, each, is_back);
        [[unroll]] for (uint r = 0u; r < SPEC_PACKET_RAYS; r++) {
            uint item = item_place(first + before[r], hit_capacity());
            if (met[r] && class_of[r] == k)
                hit_list[k * chunk.ray_capacity + place_in_tile(item)] = ids[r];
        }
    }
}

// Reserves `wanted` consecutive ids of the next generation; returns the first, or HIT_NONE where
// there is no room.
uint reserve_rays(uint wanted, inout uint status)
{
    uint next = chunk.generation + 1u;
    uint at = append_items(next, LIST_RAYS, wanted, SPEC_LIST_GROUP);
    if (wanted == 0u)
        return HIT_NONE;
    uvec2 firsts = fetch_firsts(next);
    uint segment_end = at + wanted, segment_room = generation_capacity() / SPEC_SEGMENTS;
    at += is_back ? firsts.y : firsts.x;
    uint room = is_back ? chunk.ray_capacity - middle_id() : middle_id();
    if (at + wanted > room || segment_end > segment_room) {
        status |= STATUS_QUEUE_FULL;
        return HIT_NONE;
    }
    return is_back ? chunk.ray_capacity - at - wanted : at;
}

// Counts rays that a user's functions traced. In files that trace none, compilers know `rays` to be
// 0 and drop this.
void tally_traced(uint rays)
{
    if (rays != 0u)
        atomicAdd(tally.by_functions, rays);
}

#endif

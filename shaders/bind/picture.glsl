// Push constants of a dispatch, and the buffers of the pixels that it works on.
#ifndef BIND_PICTURE_GLSL
#define BIND_PICTURE_GLSL

#include "shading.glsl"
#include "traverse.glsl"

layout(push_constant) uniform Chunk { gpu_chunk chunk; };
layout(set = 0, binding = BIND_PIXELS, std430) buffer PixelBuffer { vec4 pixels[]; };
layout(set = 0, binding = BIND_IDS, std430) writeonly buffer IdBuffer { uvec2 ids[]; };
layout(set = 0, binding = BIND_LISTED, std430) readonly buffer ListedBuffer
{
    uint listed_pixels[]; // with chunk.listed: x, and y from LISTED_Y_SHIFT on
};

// With SPEC_COUNT: RAY_KIND_COUNT per slot of the chunk, for the current sample.
layout(set = 0, binding = BIND_COSTS, std430) buffer CostBuffer { gpu_cost costs[]; };

layout(set = 0, binding = BIND_VIEWS, std430) readonly buffer ViewBuffer { gpu_view views[]; };
layout(set = 0, binding = BIND_DISTANCES, std430) writeonly buffer DistanceBuffer
{
    float distances[]; // with SPEC_VIEWS: t of the hit of the first sample's camera ray
};
gpu_view view; // of the current slot

const uint BLOCK_PIXELS = 64u; // 8 x 8

// The number of the work item that this invocation takes. The last ones may be past the end of the
// work.
uint invocation_slot()
{
    uint group = gl_WorkGroupID.x;
    if (SPEC_INTERLEAVE != 0u) {
        uint half_count = (gl_NumWorkGroups.x + 1u) / 2u;
        group = group < half_count ? group * 2u : (group - half_count) * 2u + 1u;
    }
    return group * SPEC_GROUP_SIZE + gl_LocalInvocationID.x;
}

// Whether the chunk is a part of a list of pixels.
bool is_listed()
{
    return SPEC_LISTED != 0u && chunk.listed != 0u;
}

// The place of a slot in the drawn part of the picture, which 8x8 blocks cover row by row. Within a
// block a subgroup of 8 has 4 x 2 pixels.
uvec2 slot_place(uint slot)
{
    if (is_listed()) {
        uint pixel = listed_pixels[min(chunk.first_block * BLOCK_PIXELS + slot, chunk.listed - 1u)];
        return uvec2(pixel & ((1u << LISTED_Y_SHIFT) - 1u), pixel >> LISTED_Y_SHIFT);
    }
    uint blocks_x = chunk.blocks_x, first_y = chunk.block_row;
    // The place is less than 2^14 blocks from the start of that row. Floats divide such numbers
    // exactly enough, while lavapipe divides integers lane by lane.
    uint place = chunk.first_block - first_y * blocks_x + slot / BLOCK_PIXELS;
    uint row = uint((float(place) + 0.5) / float(blocks_x));
    uvec2 block = uvec2(place - row * blocks_x, first_y + row);
    uint i = slot % BLOCK_PIXELS;
    uint x = (i & 3u) | ((i >> 1) & 4u);
    uint y = ((i >> 2) & 1u) | ((i >> 3) & 6u);
    uvec2 first = uvec2(chunk.lattice >> LATTICE_X_SHIFT, chunk.lattice >> LATTICE_Y_SHIFT);
    uvec2 shift = uvec2(chunk.lattice, chunk.lattice >> LATTICE_ROWS_SHIFT) & LATTICE_SHIFT_MASK;
    return ((block * 8u + uvec2(x, y)) << shift) + (first & LATTICE_FIRST_MASK);
}

// The number of rows that each of many views takes.
uint view_rows()
{
    return (frame.height + 7u) & ~7u;
}

// The pixel of a slot: its place within its view.
uvec2 slot_pixel(uint slot)
{
    if (SPEC_VIEWS == 0u)
        return slot_place(slot);
    uvec2 place = slot_place(slot);
    return uvec2(place.x, place.y % view_rows());
}

// Whether a place is in the picture.
bool is_in_picture(uvec2 at)
{
    if (SPEC_VIEWS != 0u)
        return at.x < frame.width && at.y % view_rows() < frame.height;
    return at.x < frame.width && at.y < min(frame.height, chunk.band_y + chunk.band_rows);
}

// With SPEC_VIEWS: copies the camera of the slot's view into the frame. Slots of a subgroup lie in
// one block, and so in one view: lists are never of views.
void load_view(uint slot)
{
    view = views[slot_place(slot).y / view_rows()];
    frame.eye = view.eye;
    frame.right = view.right;
    frame.up = view.up;
    frame.forward = view.forward;
    frame.texel_area = view.texel_area;
    frame.focus_distance = view.focus_distance;
    frame.eye_media0 = view.eye_media0;
    frame.eye_media1 = view.eye_media1;
    frame.eye_media2 = view.eye_media2;
    frame.eye_media3 = view.eye_media3;
}

// Adds the counters of the last traverse() to those of the slot's rays of `kind`. Slot HIT_NONE:
// they are dropped.
void add_cost(uint slot, uint kind)
{
    if (SPEC_COUNT == 0u || slot == HIT_NONE)
        return;
    uint at = slot * RAY_KIND_COUNT + kind; // rays of a pixel may end at the same time
    atomicAdd(costs[at].rays, traversal_cost.rays);
    atomicAdd(costs[at].inner_nodes, traversal_cost.inner_nodes);
    atomicAdd(costs[at].leaves, traversal_cost.leaves);
    atomicAdd(costs[at].instances, traversal_cost.instances);
    atomicAdd(costs[at].triangles, traversal_cost.triangles);
    atomicMax(costs[at].stack, traversal_cost.stack);
    atomicMax(costs[at].depth, traversal_cost.depth);
}

void clear_costs(uint slot)
{
    if (SPEC_COUNT == 0u)
        return;
    for (uint kind = 0u; kind < RAY_KIND_COUNT; kind++)
        costs[slot * RAY_KIND_COUNT + kind] = gpu_cost(0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u);
}

#endif

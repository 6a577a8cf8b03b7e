// Descriptors of the trees, with accessors: all that traversal reads.
#ifndef BIND_TREES_GLSL
#define BIND_TREES_GLSL

#include "../abi/bindings.h"
#include "../abi/bvh.h"
#include "../abi/spec.h"
#include "../lib/load.glsl"

layout(set = 0, binding = BIND_NODES, std430) readonly buffer NodeBuffer { uvec4 node_rows[]; };
layout(set = 0, binding = BIND_NODE_TEXELS) uniform usamplerBuffer node_texels;
layout(set = 0, binding = BIND_TRIANGLES, std430) readonly buffer TriangleBuffer
{
    uvec4 triangle_rows[];
};
layout(set = 0, binding = BIND_TRIANGLE_TEXELS) uniform usamplerBuffer triangle_texels;
layout(set = 0, binding = BIND_INSTANCES, std430) readonly buffer InstanceBuffer
{
    uvec4 instance_rows[];
};
layout(set = 0, binding = BIND_INSTANCE_TEXELS) uniform usamplerBuffer instance_texels;
layout(set = 0, binding = BIND_QUANTIZED_TEXELS) uniform usamplerBuffer quantized_texels;
layout(set = 0, binding = BIND_STATUS, std430) buffer StatusBuffer
{
    uint status_word;
    uint status_waits; // deferred items so far: see count_deferred()
    uint status_loop;  // with STATUS_FUEL: the largest number of a loop that ran out
    uint status_shape; // with STATUS_SHAPE: the largest SHAPE_* with a pixel
};

uvec4 fetch_node_row(uint row)
{
    if (SPEC_LOAD_PATH == LOAD_TEXEL)
        return texelFetch(node_texels, int(row));
    return node_rows[row];
}

uvec4 fetch_triangle_row(uint row)
{
    if (SPEC_LOAD_PATH == LOAD_TEXEL)
        return texelFetch(triangle_texels, int(row));
    return triangle_rows[row];
}

uvec4 fetch_instance_row(uint row)
{
    if (SPEC_LOAD_PATH == LOAD_TEXEL)
        return texelFetch(instance_texels, int(row));
    return instance_rows[row];
}

const uint TRIANGLE_ROWS = 3u; // of 16 bytes, in a gpu_triangle
const uint INSTANCE_ROWS = 8u; // in a gpu_instance

// World to object space, for directions and for points relative to the instance's origin.
struct InstanceFrame {
    vec3 inverse0, inverse1, inverse2, origin;
};

InstanceFrame fetch_instance_frame(uint instance)
{
    uvec4 r0 = fetch_instance_row(instance * INSTANCE_ROWS);
    uvec4 r1 = fetch_instance_row(instance * INSTANCE_ROWS + 1u);
    uvec4 r2 = fetch_instance_row(instance * INSTANCE_ROWS + 2u);
    InstanceFrame frame;
    frame.inverse0 = row_vec3(r0);
    frame.inverse1 = row_vec3(r1);
    frame.inverse2 = row_vec3(r2);
    frame.origin = vec3(uintBitsToFloat(r0.w), uintBitsToFloat(r1.w), uintBitsToFloat(r2.w));
    return frame;
}

// Whether a ray that starts on the instance and goes away from it cannot meet it again. `outside`: it
// goes to the side from which the instance's triangles are met. `instance` may be HIT_SHAPE.
bool leaves_instance(uint instance, bool outside)
{
    if (SPEC_INSTANCED == 0u || instance == HIT_SHAPE)
        return false;
    uint hull = fetch_instance_row(instance * INSTANCE_ROWS + 3u).w;
    return hull == HULL_PLANAR || (hull == HULL_CONVEX && outside);
}

// The centre of the box of an instance's mesh, in object space; without SPEC_INSTANCED all
// instances have that of the only tree.
vec3 fetch_mesh_center(uint instance)
{
    uint row = instance * INSTANCE_ROWS + 4u;
    return uintBitsToFloat(uvec3(fetch_instance_row(row).w, fetch_instance_row(row + 1u).w,
                                 fetch_instance_row(row + 2u).w));
}

float fetch_mesh_reach(uint instance)
{
    return uintBitsToFloat(fetch_instance_row(instance * INSTANCE_ROWS + 7u).x);
}

// The margin of rays in the tree over instances: see widen_world_setup. It stands in the box of node
// 1, beside the root.
void fetch_slack(out vec3 own, out vec3 others)
{
    own = row_vec3(fetch_node_row(2u));
    others = row_vec3(fetch_node_row(3u));
}

// Rows times vector, written out, since lavapipe's mat3 * vec3 adds the products in another order,
// from the right.
vec3 rotate_rows(vec3 r0, vec3 r1, vec3 r2, vec3 p)
{
    precise vec3 q;
    q.x = (r0.x * p.x + r0.y * p.y) + r0.z * p.z;
    q.y = (r1.x * p.x + r1.y * p.y) + r1.z * p.z;
    q.z = (r2.x * p.x + r2.y * p.y) + r2.z * p.z;
    return q;
}

vec3 to_object_point(InstanceFrame frame, vec3 p)
{
    precise vec3 relative = p - frame.origin;
    return rotate_rows(frame.inverse0, frame.inverse1, frame.inverse2, relative);
}

vec3 to_object_dir(InstanceFrame frame, vec3 d)
{
    return rotate_rows(frame.inverse0, frame.inverse1, frame.inverse2, d);
}

void report_status(uint bits)
{
    if (bits != 0u)
        atomicOr(status_word, bits);
}

#endif

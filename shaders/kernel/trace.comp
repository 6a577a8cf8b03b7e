// A batch of rays in, closest or any hits out. Geometry only: cut-outs count as solid.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#include "../bind/traverse.glsl"

layout(local_size_x_id = 0) in;

layout(push_constant) uniform Batch { gpu_batch batch; };
layout(set = 0, binding = BIND_RAYS, std430) readonly buffer RayBuffer { gpu_ray rays[]; };
layout(set = 0, binding = BIND_HITS, std430) buffer HitBuffer { gpu_hit hits[]; };
layout(set = 0, binding = BIND_TRACE_COSTS, std430) buffer CostBuffer
{
    gpu_cost costs[]; // with SPEC_COUNT
};

bool cutout_is_solid(uint instance, uint primitive, float u, float v)
{
    return true;
}

ivec3 filter_detail(uint instance, uint primitive, float u, float v, float way, bool front,
                    ivec3 own)
{
    return own;
}

// (v1 - v0) x (v2 - v0)
vec3 triangle_normal(uint row)
{
    vec3 v0 = row_vec3(fetch_triangle_row(row));
    precise vec3 e1 = row_vec3(fetch_triangle_row(row + 1u)) - v0;
    precise vec3 e2 = row_vec3(fetch_triangle_row(row + 2u)) - v0;
    precise vec3 n;
    n.x = e1.y * e2.z - e1.z * e2.y;
    n.y = e1.z * e2.x - e1.x * e2.z;
    n.z = e1.x * e2.y - e1.y * e2.x;
    if (SPEC_FLAT != 0u && (fetch_triangle_row(row + 1u).w & TRIANGLE_MIRRORED) != 0u)
        n = -n;
    return n;
}

// That of the triangle or the sphere, taken to world space by the inverse transpose.
vec3 geometric_normal(Hit hit)
{
    uint row = hit.triangle * TRIANGLE_ROWS;
    vec3 n = vec3(0.0);
    if (SPEC_SPHERES != SPHERES_ONLY)
        n = triangle_normal(row);
    if (SPEC_SPHERES != SPHERES_NONE &&
        (fetch_triangle_row(row + 1u).w & TRIANGLE_SPHERE) != 0u)
        n = dir_from_square(vec2(hit.u, hit.v));
    if (SPEC_INSTANCED == 0u)
        return n;
    InstanceFrame frame = fetch_instance_frame(hit.instance);
    vec3 c0 = vec3(frame.inverse0.x, frame.inverse1.x, frame.inverse2.x);
    vec3 c1 = vec3(frame.inverse0.y, frame.inverse1.y, frame.inverse2.y);
    vec3 c2 = vec3(frame.inverse0.z, frame.inverse1.z, frame.inverse2.z);
    return rotate_rows(c0, c1, c2, n);
}

Hit trace(const uint mode, uint index)
{
    gpu_ray ray = rays[index];
    Hit hit = traverse(mode, ray.origin, ray.dir, ray.t_min, ray.t_max, batch.root, HIT_NONE,
                       HIT_NONE);
    if (SPEC_NUMERICS == NUMERICS_EXACT && finds_closest(mode))
        finish_hit(ray.origin, ray.dir, hit);
    return hit;
}

void main()
{
    uint index = gl_GlobalInvocationID.x;
    bool waited = SPEC_NUMERICS == NUMERICS_EXACT && SPEC_LOOKS != 0u && batch.waiting != 0u;
    if (index >= (waited ? waiting.count : batch.ray_count))
        return;
    if (waited)
        index = waiting_items[index];
    Hit hit = SPEC_ANY_HIT != 0u ? trace(TRAVERSE_ANY, index) : trace(TRAVERSE_CLOSEST, index);
    if (SPEC_LOOKS == 0u && must_wait(hit.status)) {
        list_waiting(index);
        return;
    }
    report_status(hit.status);
    if (SPEC_COUNT != 0u)
        costs[index] = traversal_cost;
    bool met = hit.primitive != HIT_NONE;
    gpu_hit answer;
    answer.t = met ? hit.t : uintBitsToFloat(0x7f800000u);
    answer.u = met ? hit.u : 0.0;
    answer.v = met ? hit.v : 0.0;
    answer.primitive = hit.primitive;
    answer.instance = hit.instance;
    vec3 ng = met ? geometric_normal(hit) : vec3(0.0);
    answer.ng_x = ng.x;
    answer.ng_y = ng.y;
    answer.ng_z = ng.z;
    hits[index] = answer;
}

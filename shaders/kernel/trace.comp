// Traces a batch of rays to closest or any hits. It looks at geometry only: cut-outs count as
// solid.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../bind/stage.glsl"
#include "../bind/packet.glsl"
#include "../lib/wide.glsl"

layout(push_constant) uniform Batch { gpu_batch batch; };
layout(set = 0, binding = BIND_RAYS, std430) readonly buffer RayBuffer { gpu_ray rays[]; };
layout(set = 0, binding = BIND_BATCH_TEXELS) uniform usamplerBuffer ray_texels;
layout(set = 0, binding = BIND_HITS, std430) buffer HitBuffer
{
    uvec4 hit_rows[]; // two rows for each gpu_hit
};
layout(set = 0, binding = BIND_HITS, std430) buffer WideHitBuffer { u64vec4 wide_hits[]; };
layout(set = 0, binding = BIND_HITS, std430) buffer BlockedBuffer
{
    uint blocked[]; // with SPEC_ANY_HIT: 1 if there is a hit
};
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

float filter_end(vec3 origin, float t_max)
{
    return 0.0;
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

// The normal of the hit triangle or sphere, taken to world space by the inverse transpose; not unit.
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

gpu_ray fetch_ray(uint index)
{
    if (SPEC_LOAD_PATH != LOAD_TEXEL)
        return rays[index];
    uvec4 r0 = texelFetch(ray_texels, int(index * 2u)), r1 = texelFetch(ray_texels, int(index * 2u + 1u));
    return gpu_ray(row_vec3(r0), uintBitsToFloat(r0.w), row_vec3(r1), uintBitsToFloat(r1.w));
}

// Stores the result of a ray; with SPEC_ANY_HIT only whether there is a hit.
void store_answer(uint index, Hit hit)
{
    bool met = hit.primitive != HIT_NONE;
    if (SPEC_ANY_HIT != 0u) {
        blocked[index] = uint(met);
        return;
    }
    vec3 at = met ? vec3(hit.t, hit.u, hit.v) : vec3(uintBitsToFloat(0x7f800000u), 0.0, 0.0);
    vec3 ng = met ? geometric_normal(hit) : vec3(0.0);
    uvec4 r0 = uvec4(floatBitsToUint(at), hit.primitive);
    uvec4 r1 = uvec4(hit.instance, floatBitsToUint(ng));
    if (SPEC_WIDE_ROWS != 0u) {
        wide_hits[index] = wide_rows(r0, r1);
    } else {
        hit_rows[index * 2u] = r0;
        hit_rows[index * 2u + 1u] = r1;
    }
}

const uint MODE = SPEC_ANY_HIT != 0u ? TRAVERSE_ANY : TRAVERSE_CLOSEST;

// Whether `dir` is so close to `first` that a packet of such rays visits little more than each ray
// alone. Compared are the components relative to the one that is largest in `first`.
const float BEAM_WIDTH = 0.25;

bool is_near(vec3 dir, vec3 first)
{
    bvec2 dominant = make_ray_setup(vec3(0.0), first).dominant;
    vec3 a = turn_dominant(dominant, first), b = turn_dominant(dominant, dir);
    vec2 apart = abs(b.xy / b.z - a.xy / a.z);
    return a.z * b.z > 0.0 && apart.x < 0.5 * BEAM_WIDTH && apart.y < 0.5 * BEAM_WIDTH;
}

vec3 of_first(vec3 value)
{
    return vec3(subgroupShuffle(value.x, 0u), subgroupShuffle(value.y, 0u), subgroupShuffle(value.z, 0u));
}

// Lists the subgroup's rays, to be traced one by one in a second dispatch.
void list_packet(bool wanted, uint index[SPEC_PACKET_RAYS], bool alive[SPEC_PACKET_RAYS])
{
    const uint rays_each = 8u * SPEC_PACKET_RAYS;
    uint at = 0u, lane = gl_SubgroupInvocationID;
    if (wanted && lane == 0u) {
        at = atomicAdd(deferred.count, rays_each);
        atomicMax(deferred.groups_x, (at + rays_each - 1u) / SPEC_GROUP_SIZE + 1u);
    }
    at = subgroupShuffle(at, 0u);
    EACH_RAY {
        if (wanted)
            deferred_items[at + r * 8u + lane] = alive[r] ? index[r] : HIT_NONE;
    }
}

// With SPEC_COUNT the cost of a packet is that of its first ray, and the others have none. Each
// record was tested with all rays of a lane.
void store_packet_cost(uint index, uint r)
{
    bool first = r == 0u && gl_SubgroupInvocationID == 0u;
    gpu_cost cost = gpu_cost(0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u);
    if (first) {
        cost = traversal_cost;
        cost.triangles /= SPEC_PACKET_RAYS;
    }
    costs[index] = cost;
}

// Traces the subgroup's rays as a packet if they start at one point and go about the same way;
// lists them otherwise.
void trace_beam()
{
    uint index[SPEC_PACKET_RAYS];
    bool alive[SPEC_PACKET_RAYS], some = false, apart = false;
    vec3 eye, first;
    float t_min = 0.0;
    EACH_RAY {
        index[r] = gl_WorkGroupID.x * SPEC_GROUP_SIZE * SPEC_PACKET_RAYS + lane_place(r);
        alive[r] = index[r] < batch.ray_count;
        gpu_ray ray = fetch_ray(alive[r] ? index[r] : 0u);
        if (r == 0u) {
            eye = of_first(ray.origin);
            first = of_first(ray.dir);
            t_min = subgroupShuffle(ray.t_min, 0u);
        }
        bool fits = floatBitsToUint(ray.origin) == floatBitsToUint(eye) && ray.t_min == t_min &&
                    ray.t_min >= 0.0 && is_near(ray.dir, first);
        some = some || alive[r];
        apart = apart || (alive[r] && !fits);
        packet_origin[r] = ray.origin;
        packet_dir[r] = ray.dir;
        packet_t_max[r] = ray.t_max;
        packet_skip[r] = uvec2(HIT_NONE);
    }
    apart = any_lane(apart);
    list_packet(apart && any_lane(some), index, alive);
    EACH_RAY packet_alive[r] = alive[r] && !apart;
    traverse_packets(MODE, t_min, batch.root, batch.root8, eye);
    uint status = 0u;
    EACH_RAY {
        if (alive[r] && !apart)
            store_answer(index[r], packet_hits[r]);
        if (SPEC_COUNT != 0u && alive[r] && !apart)
            store_packet_cost(index[r], r);
        status |= alive[r] && !apart ? packet_hits[r].status : 0u;
    }
    report_status(status);
}

void trace_ray()
{
    uint index = gl_GlobalInvocationID.x;
    bool waited = batch.deferred != 0u, alive = index < (waited ? deferred.count : batch.ray_count);
    if (waited && has_integers())
        count_deferred();
    if (waited && alive)
        index = deferred_items[index];
    alive = alive && index != HIT_NONE;
    index = alive ? index : 0u;
    gpu_ray ray = fetch_ray(index);
    Hit hit = traverse(MODE, ray.origin, ray.dir, ray.t_min, ray.t_max, alive ? batch.root : REF_DONE,
                       HIT_NONE, HIT_NONE);
    if (SPEC_NUMERICS == NUMERICS_EXACT && finds_closest(MODE))
        finish_hit(ray.origin, ray.dir, hit);
    bool waits = alive && must_wait(hit.status);
    if (has_bounds_alone())
        list_deferred(waits, index);
    if (!alive || waits)
        return;
    report_status(hit.status);
    if (SPEC_COUNT != 0u)
        costs[index] = traversal_cost;
    store_answer(index, hit);
}

void main()
{
    if (SPEC_PACKETS != 0u)
        trace_beam();
    else
        trace_ray();
}

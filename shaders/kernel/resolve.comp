// Adds to each ray of a generation what the rays that it called for have brought, in a fixed order. Of
// camera rays to the pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#include "../bind/queues.glsl"

layout(local_size_x_id = 0) in;

vec3 child_sum(uint id)
{
    if (id == HIT_NONE)
        return vec3(0.0);
    return fetch_sum(id).rgb;
}

// How much of what lies behind it a catcher shows: what light it gets of what it would get without
// shadows. Where no light comes anyway it shows all.
vec3 caught_share(vec3 light, vec3 open)
{
    vec3 share = clamp(light / max(open, vec3(1e-30)), vec3(0.0), vec3(1.0));
    return mix(vec3(1.0), share, greaterThan(open, vec3(1e-30)));
}

void main()
{
    bool primary = chunk.generation == 0u;
    uvec2 left = fetch_counts(chunk.light, LIST_RAYS); // of the generation behind the last one
    if (left.x + left.y != 0u)
        return;
    uint item = primary ? camera_item(0u) : own_item(0u, chunk.ray_capacity);
    if (item == ITEM_NONE)
        return;
    uint id = primary ? item : fetch_listed_hit(item);
    uvec2 at = slot_pixel(slot_of(primary ? id : 0u));
    if (primary && (at.x >= frame.width || at.y >= min(frame.height, chunk.band_y + chunk.band_rows)))
        return;
    vec4 own = fetch_sum(id);
    uint has = floatBitsToUint(own.w);
    if (!primary && has == 0u)
        return;
    vec3 sum = own.rgb;
    if (SPEC_SECONDARY != 0u && has != 0u) {
        uvec4 from = fetch_children(id);
        vec3 straight = child_sum(from.y);
        if (SPEC_CATCHERS != 0u && (has & SUM_IS_CATCHER) != 0u)
            sum = straight * caught_share(own.rgb, uintBitsToFloat(hit_rows[id * HIT_ROWS].xyz));
        else
            sum = sum + child_sum(from.x) + straight + child_sum(from.z);
        if (!primary)
            sums[id] = vec4(sum, 0.0);
    }
    if (!primary)
        return;
    uint pixel = (at.y - chunk.band_y) * frame.width + at.x;
    vec4 total = vec4(sum * chunk.sample_weight, 1.0);
    uint slot = slot_of(id);
    if (CALLS_RAYS) {
        vec2 cut = vec2(cuts[slot * 2u], cuts[slot * 2u + 1u]) * (chunk.sample_weight / CUT_PARTS);
        if (chunk.summed != 0u)
            cut += vec2(counts[pixel].cut_depth_weight, counts[pixel].cut_bailout_weight);
        counts[pixel].cut_depth_weight = cut.x; // for --depth
        counts[pixel].cut_bailout_weight = cut.y;
    }
    // Samples are summed in pairs, pairs in pairs: partial sum i, of 2^i samples, waits for the next like it
    // where bit i of their number is set.
    uint row = chunk.sums_row + slot;
    for (uint carry = chunk.summed; (carry & 1u) != 0u; carry >>= 1) {
        total.rgb += pixels[row].rgb;
        row += chunk.sums_step;
    }
    bool last = chunk.summed + 1u == chunk.samples;
    if (last && (any(isnan(total.rgb)) || any(isinf(total.rgb))))
        report_status(STATUS_NON_FINITE);
    pixels[last ? pixel : row] = total;
}

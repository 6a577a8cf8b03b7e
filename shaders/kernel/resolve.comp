// Adds to the sum of each ray of a generation the sums of the rays that it called for, in a fixed
// order. The sums of camera rays go to the pixels.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../bind/stage.glsl"
#include "../bind/probe.glsl"
#include "../bind/queues.glsl"

vec3 child_sum(uint id)
{
    if (id == HIT_NONE)
        return vec3(0.0);
    return fetch_sum(id).rgb;
}

// The share of what lies behind a shadow catcher that it shows: the light that it gets over the
// light that it would get without shadows; 1 where no light comes anyway.
vec3 caught_share(vec3 light, vec3 open)
{
    vec3 share = clamp(light / max(open, vec3(1e-30)), vec3(0.0), vec3(1.0));
    return mix(vec3(1.0), share, greaterThan(open, vec3(1e-30)));
}

// The radiance that a ray brings, with that of the rays that it called for.
vec3 whole_sum(uint id, vec4 own)
{
    uint has = floatBitsToUint(own.w);
    if (SPEC_PROBE != 0u)
        probe_added(id, own.rgb, false);
    if (SPEC_SECONDARY == 0u || has == 0u)
        return own.rgb;
    uvec3 from = child_ids(has);
    vec3 straight = child_sum(from.y);
    if (SPEC_CATCHERS != 0u && (has & SUM_IS_CATCHER) != 0u) {
        vec3 share = caught_share(own.rgb, uintBitsToFloat(hit_rows[id * HIT_ROWS].xyz));
        if (SPEC_PROBE != 0u)
            probe_added(id, share, true);
        return straight * share;
    }
    return own.rgb + child_sum(from.x) + straight + child_sum(from.z);
}

void resolve_hit(uint item)
{
    uint id = fetch_listed_hit(item);
    vec4 own = fetch_sum(id);
    if (floatBitsToUint(own.w) != 0u || SPEC_PROBE != 0u)
        store_sum(id, whole_sum(id, own), 0u);
}

// Adds the weights of the sample's cut rays, by --depth and by --bailout, to those of the pixel,
// and keeps the largest sum over all pixels in the tally.
void add_cuts(bool alive, uint slot, uint pixel)
{
    vec2 cut = vec2(0.0);
    if (alive) {
        cut = fetch_cuts(slot) * chunk.sample_weight;
        uint at = SPEC_PIXEL_DATA != 0u ? pixel : chunk.tile_slot + slot;
        if (chunk.summed != 0u)
            cut += cut_sums[at];
        cut_sums[at] = cut;
    }
    uint depth = max_of_lanes(floatBitsToUint(cut.x)), bailout = max_of_lanes(floatBitsToUint(cut.y));
    if (is_first_lane() && depth != 0u)
        atomicMax(tally.cut_depth_weight, depth);
    if (is_first_lane() && bailout != 0u)
        atomicMax(tally.cut_bailout_weight, bailout);
}

// Adds the sample's values of the user's aov functions; pixels get their mean, as they do of
// colours.
void add_aovs(uint slot, uint pixel)
{
    for (uint i = 0u; i < SPEC_AOVS; i++) {
        uint at = (chunk.sums_step + pixel) * SPEC_AOVS + i;
        vec4 sum = aovs[slot * SPEC_AOVS + i] * chunk.sample_weight;
        if (chunk.summed != 0u)
            sum += aovs[at];
        aovs[at] = sum;
    }
}

void resolve_pixel(uint id)
{
    bool alive = id != ITEM_NONE;
    uint slot = alive ? id : 0u;
    uvec2 at = slot_place(slot);
    alive = alive && is_in_picture(at);
    uint pixel = (at.y - chunk.band_y) * frame.width + at.x;
    bool alone = SPEC_AOVS != 0u && chunk.aovs_alone != 0u;
    if (CALLS_RAYS && !alone)
        add_cuts(alive, slot, pixel);
    if (!alive)
        return;
    if (SPEC_AOVS != 0u)
        add_aovs(slot, pixel);
    if (alone)
        return;
    vec4 total = vec4(whole_sum(id, fetch_sum(id)) * chunk.sample_weight, 1.0);
    // Samples are summed pairwise: partial sum i holds 2^i samples, and waits for the next sum of
    // as many where bit i of the number of summed samples is set. After the last sample all waiting
    // sums are added; for 2^i samples this is the same.
    bool last = chunk.summed + 1u == chunk.samples;
    uint row = chunk.sums_row + chunk.tile_slot + slot;
    for (uint waiting = chunk.summed; last ? waiting != 0u : (waiting & 1u) != 0u; waiting >>= 1) {
        if ((waiting & 1u) != 0u)
            total.rgb += pixels[row].rgb;
        row += chunk.sums_step;
    }
    bool posted = (SPEC_HOOKS & HOOK_POST) != 0u; // post.comp, run later, checks the colour
    if (last && !posted && (any(isnan(total.rgb)) || any(isinf(total.rgb))))
        report_status(STATUS_NON_FINITE);
    pixels[last ? (posted ? chunk.before_post : 0u) + pixel : row] = total;
}

void main()
{
    load_frame();
    bool done = is_tile_done();
    uint item = is_primary() ? camera_item(0u) : invocation_item(0u, chunk.ray_capacity);
    if (is_primary())
        resolve_pixel(done ? item : ITEM_NONE);
    else if (done && item != ITEM_NONE)
        resolve_hit(item);
}

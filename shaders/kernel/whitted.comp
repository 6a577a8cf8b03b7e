// One ray of each pixel's ray tree (Whitted 1980): a camera ray, or the top of the pixel's ray
// stack. Local light with shadows goes to the pixel, the rays it calls for go on the stack. Pixels
// with rays left are listed for the next dispatch, so that no dispatch runs long. Without trees one
// ray is several dispatches, see BRUTE_*.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../lib/optics.glsl"
#include "../bind/light.glsl"
#include "../bind/runs.glsl"
#include "../bind/surface.glsl"

layout(local_size_x_id = 0) in;

layout(push_constant) uniform Chunk { gpu_chunk chunk; };
layout(set = 0, binding = BIND_PIXELS, std430) buffer PixelBuffer { vec4 pixels[]; };
layout(set = 0, binding = BIND_IDS, std430) writeonly buffer IdBuffer { uvec2 ids[]; };
layout(set = 0, binding = BIND_COUNTS, std430) buffer CountBuffer { gpu_counts counts[]; };
layout(set = 0, binding = BIND_RAY_STACKS, std430) buffer RayStackBuffer
{
    gpu_stacked_ray ray_stacks[]; // frame.stack_size per slot of the chunk
};
layout(set = 0, binding = BIND_WORK_IN, std430) readonly buffer WorkInBuffer
{
    gpu_work work_in;
    uint slots_in[];
};
layout(set = 0, binding = BIND_WORK_OUT, std430) buffer WorkOutBuffer
{
    gpu_work work_out;
    uint slots_out[];
};

// RAY_KIND_COUNT per slot of the chunk, for the sample in the making; with SPEC_COUNT.
layout(set = 0, binding = BIND_COSTS, std430) buffer CostBuffer { gpu_cost costs[]; };

layout(set = 0, binding = BIND_RUNS, std430) readonly buffer RunBuffer { gpu_run runs[]; };
layout(set = 0, binding = BIND_FOUND, std430) buffer FoundBuffer { gpu_found found[]; };
layout(set = 0, binding = BIND_PASSED, std430) buffer PassedBuffer
{
    gpu_passed passed[]; // frame.light_count per slot of the chunk
};

gpu_run fetch_run(uint index)
{
    return runs[index];
}

const uint BLOCK_PIXELS = 64u; // 8 x 8

struct Ray {
    vec3 origin, dir, weight;
    uint bounces, medium, skip_primitive, skip_instance;
    uint kind; // RAY_*; with SPEC_COUNT
};

// Which item of the work this invocation takes; the last ones may be past its end.
uint own_slot()
{
    uint group = gl_WorkGroupID.x;
    if (SPEC_INTERLEAVE != 0u) {
        uint half_count = (gl_NumWorkGroups.x + 1u) / 2u;
        group = group < half_count ? group * 2u : (group - half_count) * 2u + 1u;
    }
    return group * SPEC_GROUP_SIZE + gl_LocalInvocationID.x;
}

// Pixel of a slot: blocks row by row over the picture; within a block 4 x 2 pixels a subgroup of 8.
uvec2 slot_pixel(uint slot)
{
    uint blocks_x = (frame.width + 7u) / 8u;
    uint block = chunk.first_block + slot / BLOCK_PIXELS;
    uint i = slot % BLOCK_PIXELS;
    uint x = (i & 3u) | ((i >> 1) & 4u);
    uint y = ((i >> 2) & 1u) | ((i >> 3) & 6u);
    return uvec2(block % blocks_x, block / blocks_x) * 8u + uvec2(x, y);
}

// camera_ray of render/camera.c is this in C, bit for bit: so no normalize(), whose bits are the
// driver's choice.
Ray camera_ray(uvec2 pixel)
{
    precise vec2 at =
        (vec2(pixel) + chunk.sample_xy) / vec2(frame.width, frame.height) * 2.0 - 1.0;
    precise vec3 in_plane = frame.right * at.x - frame.up * at.y;
    precise vec3 origin = frame.eye + in_plane;
    precise vec3 dir = frame.forward + in_plane;
    if (SPEC_ORTHOGRAPHIC != 0u)
        dir = frame.forward;
    else
        origin = frame.eye;
    precise float size = sqrt((dir.x * dir.x + dir.y * dir.y) + dir.z * dir.z);
    precise vec3 unit = dir / size;
    Ray ray;
    ray.origin = origin;
    ray.dir = unit;
    ray.weight = vec3(1.0);
    ray.bounces = 0u;
    ray.medium = 0u;
    ray.skip_primitive = HIT_NONE;
    ray.skip_instance = HIT_NONE;
    ray.kind = RAY_PRIMARY;
    return ray;
}

Ray stacked_ray(uint index)
{
    gpu_stacked_ray stacked = ray_stacks[index];
    Ray ray;
    ray.origin = stacked.origin;
    ray.dir = stacked.dir;
    ray.weight = stacked.weight;
    ray.bounces = stacked.state & 255u;
    ray.medium = (stacked.state >> STATE_MEDIUM_SHIFT) & STATE_MEDIUM_MASK;
    ray.kind = stacked.state >> STATE_KIND_SHIFT;
    ray.skip_primitive = stacked.skip_primitive;
    ray.skip_instance = stacked.skip_instance;
    return ray;
}

// What a hit does with light: the Whitted model, after textures.
struct Optics {
    vec3 diffuse, ambient, highlight, emission;
    vec3 reflected, refracted; // weights of the two rays
    float straight;            // share that passes undisturbed (opacity)
    float shininess, alpha;    // of Blinn's highlight; of GGX
    float eta;
    bool thin, unlit, metal_rough;
};

Optics surface_optics(inout Surface s, gpu_material m, vec3 dir, bool inside)
{
    Optics o;
    o.unlit = m.model == MATERIAL_MODEL_UNLIT;
    o.metal_rough = SPEC_METAL_ROUGH != 0u && m.model == MATERIAL_MODEL_METAL_ROUGH;
    o.diffuse = m.diffuse * s.color;
    o.ambient = m.ambient;
    o.highlight = m.specular;
    o.emission = m.emission;
    o.shininess = m.shininess;
    o.straight = 0.0;
    float opacity = m.opacity * s.color_alpha;
    float metallic = m.metallic, roughness = m.roughness, specular_level = m.specular_level;
    vec3 transmission = m.transmission;
    if (SPEC_TEXTURES != 0u) {
        vec4 texel = vec4(1.0);
        if (m.tex_diffuse != TEXTURE_NONE)
            texel = sample_use(s, m.tex_diffuse);
        o.diffuse *= texel.rgb;
        o.ambient *= texel.rgb;
        if (m.tex_specular != TEXTURE_NONE)
            o.highlight *= sample_use(s, m.tex_specular).rgb;
        if (m.tex_emission != TEXTURE_NONE)
            o.emission *= sample_use(s, m.tex_emission).rgb;
        if (SPEC_METAL_ROUGH != 0u && m.tex_metal_rough != TEXTURE_NONE) {
            vec2 gb = sample_use(s, m.tex_metal_rough).gb;
            roughness *= gb.x;
            metallic *= gb.y;
        }
        if (SPEC_METAL_ROUGH != 0u && m.tex_specular_level != TEXTURE_NONE)
            specular_level *= sample_use(s, m.tex_specular_level).a;
        if (SPEC_REFRACTION != 0u && m.tex_transmission != TEXTURE_NONE)
            transmission *= sample_use(s, m.tex_transmission).r;
    }
    if (SPEC_CUTOUTS != 0u && (m.flags & MATERIAL_BLEND) != 0u) {
        if (m.tex_opacity != TEXTURE_NONE)
            opacity = sample_opacity(m, s.shade_index, s.u, s.v) * s.color_alpha;
        o.straight = clamp(1.0 - opacity, 0.0, 1.0);
    }
    if (SPEC_NORMAL_MAPS != 0u)
        bend_normal(s, m);

    float cos_view = clamp(abs(dot(dir, s.ns)), 0.0, 1.0);
    o.eta = inside ? m.ior : 1.0 / m.ior;
    o.thin = (m.flags & MATERIAL_THIN) != 0u;
    o.reflected = SPEC_REFLECTION != 0u ? m.reflection : vec3(0.0);
    o.alpha = 1.0;
    bool fresnel = (m.flags & MATERIAL_FRESNEL) != 0u;
    float gloss = 1.0; // share of the mirror ray that roughness leaves
    if (o.metal_rough) {
        float r0 = (m.ior - 1.0) / (m.ior + 1.0);
        vec3 f0 = min(o.highlight * (r0 * r0), vec3(1.0)) * specular_level;
        f0 = mix(f0, o.diffuse, metallic);
        gloss = (1.0 - roughness) * (1.0 - roughness);
        vec3 edge = max(vec3(1.0 - roughness) * mix(specular_level, 1.0, metallic), f0);
        vec3 f = f0 + (edge - f0) * schlick_weight(cos_view);
        vec3 kept = 1.0 - clamp(transmission, 0.0, 1.0);
        transmission *= o.diffuse * (1.0 - metallic);
        o.diffuse *= (1.0 - metallic) * kept;
        o.ambient = o.diffuse + f0 * (1.0 - gloss);
        o.highlight = f0;
        o.alpha = max(roughness * roughness, 0.02);
        o.reflected = SPEC_REFLECTION != 0u ? f * gloss : vec3(0.0);
    } else if (fresnel && SPEC_REFRACTION == 0u) {
        o.reflected += (vec3(1.0) - o.reflected) * schlick_weight(cos_view) *
                       float(max(o.reflected.r, max(o.reflected.g, o.reflected.b)) > 0.0);
    }
    o.refracted = vec3(0.0);
    if (SPEC_REFRACTION != 0u) {
        bool glass = max(transmission.r, max(transmission.g, transmission.b)) > 0.0;
        float share = o.thin ? fresnel_dielectric(cos_view, 1.0 / m.ior)
                             : fresnel_dielectric(cos_view, o.eta);
        if (o.thin) // both faces of a sheet, without interference
            share = 2.0 * share / (1.0 + share);
        bool total = !o.thin && o.eta * o.eta * (1.0 - cos_view * cos_view) >= 1.0;
        if (glass) {
            o.refracted = fresnel ? transmission * (1.0 - share) : transmission;
            if (total)
                o.refracted = vec3(0.0);
            if (fresnel || total)
                o.reflected = vec3(total ? 1.0 : share * gloss);
        } else if (fresnel && !o.metal_rough) {
            o.reflected += (vec3(1.0) - o.reflected) * schlick_weight(cos_view) *
                           float(max(o.reflected.r, max(o.reflected.g, o.reflected.b)) > 0.0);
        }
        if (SPEC_REFLECTION == 0u && !total)
            o.reflected = vec3(0.0);
    }
    return o;
}

// Adds what the last traverse() cost to the pixel's rays of `kind`.
void add_cost(uint slot, uint kind)
{
    if (SPEC_COUNT == 0u)
        return;
    uint at = slot * RAY_KIND_COUNT + kind;
    costs[at] = add_up(costs[at], traversal_cost);
}

void clear_costs(uint slot)
{
    if (SPEC_COUNT == 0u)
        return;
    for (uint kind = 0u; kind < RAY_KIND_COUNT; kind++)
        costs[slot * RAY_KIND_COUNT + kind] = gpu_cost(0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u);
}

// What the shadow ray of a light meets. Without trees: in the ranges so far.
Hit find_blocker(uint slot, uint light, vec3 origin, vec3 to_light, float distance, Hit from)
{
    Hit blocker;
    if (SPEC_BRUTE == BRUTE_OFF) {
        blocker = traverse(TRAVERSE_SHADOW, origin, to_light, 0.0, distance, frame.root,
                           from.instance, from.primitive);
        add_cost(slot, RAY_SHADOW);
        return blocker;
    }
    uint at = slot * frame.light_count + light;
    blocker = make_hit(distance);
    if (SPEC_BRUTE == BRUTE_SHADE || chunk.begin == 0u) {
        gpu_passed before = passed[at];
        blocker.filter_depth = uvec3(before.red, before.green, before.blue);
        blocker.primitive = before.blocked != 0u ? 0u : HIT_NONE;
    }
    if (SPEC_BRUTE == BRUTE_SHADOW) {
        traverse_runs(TRAVERSE_SHADOW, origin, to_light, 0.0, chunk.first_run, chunk.begin,
                      from.instance, from.primitive, blocker);
        add_cost(slot, RAY_SHADOW);
        passed[at] = gpu_passed(blocker.filter_depth.r, blocker.filter_depth.g,
                                blocker.filter_depth.b, uint(blocker.primitive != HIT_NONE));
    }
    return blocker;
}

// How much of a light passes to `p`: 1 less opaque things in between, times the filters.
vec3 light_share(uint slot, uint light, vec3 p, vec3 error, vec3 side, vec3 to_light,
                 float distance, Hit from, inout uint status)
{
    if (SPEC_SHADOWS == 0u)
        return vec3(1.0);
    vec3 origin = offset_origin(p, error, side);
    Hit blocker = find_blocker(slot, light, origin, to_light, distance, from);
    status |= blocker.status;
    if (blocker.primitive != HIT_NONE)
        return vec3(0.0);
    if (SPEC_FILTERS == 0u)
        return vec3(1.0);
    return exp2(vec3(blocker.filter_depth) * (-1.0 / SHADOW_DEPTH_SCALE));
}

// Light from all lights, towards the eye. The phase BRUTE_SHADOW has one light.
vec3 local_light(uint slot, Surface s, Optics o, vec3 view, Hit hit, inout uint shadow_rays,
                 inout uint status)
{
    vec3 sum = o.emission + o.ambient * frame.ambient;
    if (SPEC_LIGHTS == 0u)
        return sum;
    float cos_view = max(dot(view, s.ns), 0.0);
    uint i = SPEC_BRUTE == BRUTE_SHADOW ? chunk.light : 0u;
    do {
        vec3 to_light, arriving;
        float distance;
        bool lit = i < frame.light_count && light_at(i, s.p, to_light, distance, arriving);
        float cos_light = dot(to_light, s.ns);
        lit = lit && cos_light > 0.0 && dot(to_light, s.ng) > 0.0;
        vec3 reflected = o.diffuse * cos_light;
        if (SPEC_HIGHLIGHTS != 0u) {
            vec3 middle = normalize_or(to_light + view, s.ns);
            float cos_half = clamp(dot(middle, s.ns), 0.0, 1.0);
            reflected += o.metal_rough
                             ? o.highlight * cos_light *
                                   ggx_highlight(cos_half, cos_light, cos_view, o.alpha)
                             : o.highlight * blinn_highlight(cos_half, o.shininess);
        }
        lit = lit && max(reflected.r, max(reflected.g, reflected.b)) > 0.0;
        if (lit) {
            vec3 share =
                light_share(slot, i, s.p, s.error, s.ng, to_light, distance, hit, status);
            sum += reflected * arriving * share;
            if (SPEC_SHADOWS != 0u)
                shadow_rays++;
        }
        i++;
    } while (SPEC_BRUTE != BRUTE_SHADOW && i < frame.light_count);
    if (SPEC_BRUTE != BRUTE_SHADOW && i < frame.light_count)
        status |= STATUS_UNFINISHED_LOOP;
    return sum;
}

void push_ray(uint slot, inout uint top, vec3 origin, vec3 dir, vec3 weight, uint bounces,
              uint medium, uint kind, Hit hit, inout uint status)
{
    if (top >= frame.stack_size) {
        status |= STATUS_RAY_STACK_OVERFLOW;
        return;
    }
    gpu_stacked_ray stacked;
    stacked.origin = origin;
    stacked.dir = dir;
    stacked.weight = weight;
    stacked.state = bounces | (medium << STATE_MEDIUM_SHIFT);
    if (SPEC_COUNT != 0u)
        stacked.state |= kind << STATE_KIND_SHIFT;
    stacked.skip_primitive = hit.primitive;
    stacked.skip_instance = hit.instance;
    ray_stacks[slot * frame.stack_size + top] = stacked;
    top++;
}

bool worth(vec3 weight)
{
    return max(weight.r, max(weight.g, weight.b)) >= frame.bailout;
}

// The rays that the surface calls for.
void push_children(uint slot, Ray ray, Surface s, Optics o, bool inside, Hit hit,
                   inout gpu_counts count, inout uint status)
{
    if (SPEC_SECONDARY == 0u || SPEC_BRUTE == BRUTE_SHADOW || ray.bounces >= frame.depth)
        return;
    uint bounces = ray.bounces + 1u;
    float solid = 1.0 - o.straight;
    if (SPEC_REFRACTION != 0u) {
        vec3 weight = ray.weight * o.refracted * solid;
        vec3 dir = ray.dir;
        bool passes = o.thin || refract_dir(ray.dir, s.ns, o.eta, dir);
        // A shading normal may bend the ray back to its own side: then straight on.
        if (dot(dir, s.ng) >= 0.0)
            dir = ray.dir;
        if (passes && worth(weight)) {
            uint medium = o.thin ? ray.medium : inside ? 0u : s.material + 1u;
            push_ray(slot, count.stack, offset_origin(s.p, s.error, -s.ng), dir, weight, bounces,
                     medium, RAY_REFRACTED, hit, status);
            count.refracted++;
        }
    }
    if (SPEC_CUTOUTS != 0u) {
        vec3 weight = ray.weight * o.straight;
        if (worth(weight))
            push_ray(slot, count.stack, offset_origin(s.p, s.error, -s.ng), ray.dir, weight,
                     bounces, ray.medium, ray.kind, hit, status);
    }
    if (SPEC_REFLECTION != 0u || SPEC_REFRACTION != 0u) {
        vec3 weight = ray.weight * o.reflected * solid;
        vec3 dir = reflect(ray.dir, s.ns);
        if (dot(dir, s.ng) <= 0.0)
            dir = reflect(ray.dir, s.ng);
        if (worth(weight)) {
            push_ray(slot, count.stack, offset_origin(s.p, s.error, s.ng), normalize(dir), weight,
                     bounces, ray.medium, RAY_REFLECTED, hit, status);
            count.reflected++;
        }
    }
}

vec3 medium_transmittance(uint medium, float t)
{
    if (SPEC_ABSORPTION == 0u || medium == 0u)
        return vec3(1.0);
    vec3 depth = fetch_material(medium - 1u).absorption * t;
    return exp(-clamp(depth, vec3(0.0), vec3(100.0)));
}

vec3 shade_hit(uint slot, Ray ray, Hit hit, inout gpu_counts count, inout uint status)
{
    Surface s = fetch_surface(hit);
    gpu_material m = fetch_material(s.material);
    ray.weight *= medium_transmittance(ray.medium, hit.t);
    bool inside = dot(ray.dir, s.ng) > 0.0;
    if (inside) {
        s.ng = -s.ng;
        s.ns = -s.ns;
    }
    if (dot(s.ns, s.ng) < 0.0)
        s.ns = -s.ns;
    if (dot(s.ns, ray.dir) > 0.0)
        s.ns = s.ng;
    Optics o = surface_optics(s, m, ray.dir, inside);
    if (dot(s.ns, ray.dir) > 0.0)
        s.ns = s.ng;
    push_children(slot, ray, s, o, inside, hit, count, status);
    vec3 light = o.unlit ? o.diffuse + o.emission
                         : local_light(slot, s, o, -ray.dir, hit, count.shadow, status);
    return light * ray.weight * (1.0 - o.straight);
}

Hit found_hit(uint slot)
{
    gpu_found before = found[slot];
    Hit hit = make_hit(FLOAT_LARGEST);
    if (before.primitive == HIT_NONE)
        return hit;
    hit.t = before.t;
    hit.u = before.u;
    hit.v = before.v;
    hit.triangle = before.triangle;
    hit.primitive = before.primitive;
    hit.instance = before.instance;
    return hit;
}

// Without trees: the phases before BRUTE_SHADE. Leaves the pixel alone.
void extend_ranges(uint slot, Ray ray)
{
    Hit hit = make_hit(FLOAT_LARGEST);
    if (SPEC_BRUTE == BRUTE_SHADOW || chunk.begin == 0u)
        hit = found_hit(slot);
    if (SPEC_BRUTE == BRUTE_CLOSEST) {
        traverse_runs(TRAVERSE_CLOSEST, ray.origin, ray.dir, 0.0, chunk.first_run, chunk.begin,
                      ray.skip_instance, ray.skip_primitive, hit);
        add_cost(slot, ray.kind);
        found[slot] = gpu_found(hit.t, hit.u, hit.v, hit.triangle, hit.primitive, hit.instance,
                                0u, 0u);
        report_status(hit.status);
    } else if (hit.primitive != HIT_NONE) {
        gpu_counts ignored = gpu_counts(0u, 0u, 0u, 0u);
        uint status = 0u;
        shade_hit(slot, ray, hit, ignored, status);
        report_status(status);
    }
}

void list_for_next(uint slot)
{
    uint at = atomicAdd(work_out.count, 1u);
    slots_out[at] = slot;
    atomicMax(work_out.groups_x, at / SPEC_GROUP_SIZE + 1u);
}

void main()
{
    bool stacked = SPEC_SECONDARY != 0u && chunk.stacked != 0u;
    uint slot = own_slot();
    if (slot >= (stacked ? work_in.count : chunk.block_count * BLOCK_PIXELS))
        return;
    if (stacked)
        slot = slots_in[slot];
    uvec2 at = slot_pixel(slot);
    if (at.x >= frame.width || at.y >= min(frame.height, chunk.band_y + chunk.band_rows))
        return;
    uint pixel = (at.y - chunk.band_y) * frame.width + at.x;

    gpu_counts count = gpu_counts(0u, 0u, 0u, 0u);
    if (stacked || chunk.sample_index != 0u)
        count = counts[pixel];
    Ray ray = camera_ray(at);
    if (stacked) {
        count.stack--;
        ray = stacked_ray(slot * frame.stack_size + count.stack);
    } else {
        count.stack = 0u;
        if (SPEC_BRUTE == BRUTE_OFF || (SPEC_BRUTE == BRUTE_CLOSEST && chunk.begin != 0u))
            clear_costs(slot);
    }
    if (SPEC_BRUTE == BRUTE_CLOSEST || SPEC_BRUTE == BRUTE_SHADOW) {
        extend_ranges(slot, ray);
        return;
    }
    Hit hit;
    if (SPEC_BRUTE == BRUTE_SHADE) {
        hit = found_hit(slot);
    } else {
        hit = traverse(TRAVERSE_CLOSEST, ray.origin, ray.dir, 0.0, FLOAT_LARGEST, frame.root,
                       ray.skip_instance, ray.skip_primitive);
        add_cost(slot, ray.kind);
    }
    uint status = hit.status;
    bool met = hit.primitive != HIT_NONE;
    vec3 radiance = environment_radiance(ray.dir) * ray.weight;
    if (met)
        radiance = shade_hit(slot, ray, hit, count, status);

    if (any(isnan(radiance)) || any(isinf(radiance)))
        status |= STATUS_NON_FINITE;
    vec4 sum = vec4(radiance * chunk.sample_weight, 1.0);
    if (stacked || chunk.sample_index != 0u)
        sum.rgb += pixels[pixel].rgb;
    pixels[pixel] = sum;
    counts[pixel] = count;
    if (!stacked && chunk.sample_index == 0u)
        ids[pixel] = uvec2(hit.instance, hit.primitive);
    if (SPEC_SECONDARY != 0u && count.stack != 0u)
        list_for_next(slot);
    report_status(status);
}

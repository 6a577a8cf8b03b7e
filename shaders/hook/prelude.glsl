// Functions that those of a user's file may call besides each other. hook/interface.glsl declares
// them for users and says what they give; lib/records.glsl has the records.
#ifndef HOOK_PRELUDE_GLSL
#define HOOK_PRELUDE_GLSL

#include "../bind/arrival.glsl"
#include "../bind/hook.glsl"
#include "../bind/lit_surface.glsl"

// The state of a call. Those up to hook_media are set before each call of a user's function.
uvec2 hook_pixel;
Hit hook_hit;            // of the surface
uint hook_shade;         // its shade_index
uvec4 hook_media;        // media around it
Hit traced_hit;          // what trace() has met last
uint traced_shade;       // its shade_index
uint hook_status = 0u;   // STATUS_* of the rays that the user's functions have traced
uint hook_traced = 0u;   // number of those rays
uint whit_fuel = 0u;     // iterations of loops that the call may still take
uint whit_fuel_loop = 0u; // number of the loop that used up whit_fuel; 0: none
uint hook_loop = 0u;      // the largest whit_fuel_loop of all calls
uint hook_shape = 0u;     // for status_shape: what is wrong with answers for a shape

#include "record.glsl"

void begin_hook()
{
    whit_fuel = SPEC_FUEL;
    whit_fuel_loop = 0u;
}

void end_hook(bool alive)
{
    hook_loop = alive ? max(hook_loop, whit_fuel_loop) : hook_loop;
}

// The user's camera() is called for each camera ray that is made, whether the kernel needs it or
// not. Where it does not, the rays that camera() traced are not counted. `before`: hook_traced
// before the call.
void count_camera(uint before, bool of_use)
{
    if ((SPEC_HOOKS & HOOK_CAMERA) != 0u && !of_use)
        hook_traced = before;
}

// Call it behind all loops of the kernel. The first loop here asks for a second iteration. If it has
// none, the driver may have ended loops of the user's before they were done (lib/turn.glsl).
void report_hooks()
{
    uint iteration = 0u;
    bool more = false;
    do {
        iteration++;
        more = iteration < frame.iterations;
    } while (another_iteration(more));
    if (more)
        report_status(STATUS_CUT_LOOPS);
    if (hook_loop != 0u) {
        atomicMax(status_loop, hook_loop + (HOOK_KERNEL << 16));
        report_status(STATUS_FUEL);
    }
    if (hook_shape != 0u) {
        atomicMax(status_shape, hook_shape);
        report_status(STATUS_SHAPE);
    }
}

float slider(uint index)
{
    return stored_sliders[min(index, SLIDERS_MAX - 1u)];
}

// ---- The ray ----

vec3 ray_origin()
{
    return hook_ray.origin;
}

float ray_distance()
{
    return hook_hit.t;
}

uint bounces()
{
    return ray_bounces(hook_ray.steps);
}

// ---- The picture ----

uvec2 pixel()
{
    return hook_pixel;
}

uvec2 picture_size()
{
    return uvec2(frame.width, frame.height);
}

uint sample_number()
{
    return chunk.sample_index;
}

vec3 eye()
{
    return frame.eye;
}

uint hash(uint x) // PCG, after Jarzynski and Olano 2020
{
    x = x * 747796405u + 2891336453u;
    x = ((x >> ((x >> 28) + 4u)) ^ x) * 277803737u;
    return x >> 22 ^ x;
}

float random(uint k)
{
    uvec2 at = pixel();
    uvec3 way = floatBitsToUint(hook_ray.dir);
    uint seed = hash(at.x ^ hash(at.y ^ hash(chunk.sample_index)));
    // The steps tell apart rays that go straight on.
    seed = hash(seed ^ hook_ray.steps ^ hash(way.x ^ hash(way.y ^ hash(way.z))));
    return float(hash(seed + k) >> 8) * (1.0 / 16777216.0);
}

// ---- Light ----

vec3 ambient()
{
    return frame.ambient;
}

uint light_count()
{
    return frame.light_count;
}

// Light `index` of the scene, which has at least one; an index beyond the last light means the
// last.
gpu_light light_of(uint index)
{
    return fetch_light(min(index, frame.light_count - 1u));
}

uint light_points(uint index)
{
    if (frame.light_count == 0u)
        return 0u;
    return is_flat(light_of(index)) ? turns_each() : 1u;
}

Light light(uint index, uint point, Surface s)
{
    if (frame.light_count == 0u)
        return Light(s.ns, 0.0, vec3(0.0));
    LightSample at;
    bool arrives = light_at(light_of(index), point, s.p, at);
    return Light(at.to_light, at.distance, arrives ? at.arriving : vec3(0.0));
}

// ---- Rays ----

vec3 off_surface(Surface s, vec3 dir)
{
    return offset_origin(s.p, s.error, dot(dir, s.ng) < 0.0 ? -s.ng : s.ng);
}

// Tests the user's shape, which is in no tree (hook/shape.glsl).
void add_shape(vec3 origin, vec3 dir, bool alive, inout Hit hit);

// Instance and primitive that do not block rays from the surface: those of the surface, if it is the
// one of this call or of the last trace(). Rays from any other surface start a little off it instead
// (off_surface).
uvec2 skip_of(Surface s)
{
    if (s.instance == hook_hit.instance && s.shade_index == hook_shade)
        return uvec2(hook_hit.instance, hook_hit.primitive);
    if (s.instance == traced_hit.instance && s.shade_index == traced_shade)
        return uvec2(traced_hit.instance, traced_hit.primitive);
    return uvec2(HIT_NONE);
}

// The share of light that comes to `origin` from the distance `distance` along `dir`: 1 where
// nothing is in between, 0 behind something opaque.
vec3 visible_from(vec3 origin, vec3 dir, float distance, uvec2 skip, vec3 absorption)
{
    if (SPEC_SHADOWS == 0u)
        return vec3(1.0);
    Hit blocker = traverse(TRAVERSE_SHADOW, origin, dir, 0.0, distance, frame.root, skip.x, skip.y);
    if ((SPEC_HOOKS & HOOK_INTERSECT) != 0u && blocker.primitive == HIT_NONE)
        add_shape(origin, dir, is_usable(origin, dir), blocker);
    hook_status |= blocker.status;
    hook_traced++;
    return passing_share(blocker, absorption);
}

// visible_from for a surface, which does not block itself.
vec3 visible(Surface s, vec3 dir, float distance)
{
    return visible_from(off_surface(s, dir), dir, distance, skip_of(s), surrounding_absorption(hook_media));
}

bool trace(vec3 origin, vec3 dir, out Surface met, out float distance)
{
    Hit hit = traverse(TRAVERSE_CLOSEST, origin, dir, 0.0, FLOAT_LARGEST, frame.root, HIT_NONE, HIT_NONE);
    if ((SPEC_HOOKS & HOOK_INTERSECT) != 0u)
        add_shape(origin, dir, is_usable(origin, dir), hit);
    hook_status |= hit.status;
    hook_traced++;
    bool some = hit.primitive != HIT_NONE;
    distance = hit.t;
    if (some) {
        met_origin = origin;
        met_dir = dir;
        met = fetch_surface(hit);
        traced_hit = hit;
        traced_shade = met.shade_index;
        face_ray(met, dir);
    }
    return some;
}

vec3 lit_by(uint index, Surface s, Optics o, vec3 to_eye)
{
    if (frame.light_count == 0u)
        return vec3(0.0);
    Lit lit = lit_surface(s, o, vec3(1.0), hook_media);
    uvec2 own = skip_of(s);
    lit.view = to_eye;
    gpu_light from = light_of(index);
    EmitterSum emitter = EmitterSum(0.0, vec3(0.0), vec3(0.0));
    vec3 sum = vec3(0.0);
    uint points = light_points(index);
    for (uint point = 0u; point < points; point++) {
        Arrival a = arrive(true, lit, from, point);
        vec3 share = vec3(0.0);
        if (a.wanted)
            share = visible_from(lit.origin, a.dir, a.distance,
                                 uvec2(own.x, a.above ? own.y : HIT_NONE), lit.absorption);
        float weight = a.faces ? a.cos_light * a.strength : 0.0;
        emitter.weight += weight;
        emitter.visible += share * weight;
        emitter.highlight += a.highlight * share * a.strength;
        sum += a.reflected * a.arriving * share;
    }
    vec3 open;
    return is_flat(from) ? emitter_light(from, lit, emitter, open) : sum;
}

#endif

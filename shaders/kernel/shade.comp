// Shades the hits of a generation: adds the surfaces' own light to the sums, lists hits for the
// lights, and makes the rays of the next generation.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../bind/stage.glsl"
#include "../bind/queues.glsl"
#include "../bind/arrival.glsl"
#include "../bind/crossing.glsl"
#include "../bind/hook.glsl"
#include "../bind/lit_surface.glsl"
#include "../bind/probe.glsl"

#ifdef HOOKS
#include "../hook/declare.glsl"
#else
#define scatter whit_scatter
#include "../hook/scatter.glsl"
#endif
#include "../hook/met.glsl"

// The rays that a hit calls for, in the order in which their light is added.
struct Calls {
    vec3 dir[3], weight[3]; // index: 0 refracted, 1 straight, 2 reflected
    bool wanted[3];
    uint ends[3]; // with SPEC_PROBE: why it is not traced, PROBE_DEPTH or PROBE_BAILOUT
    uint steps;
    uint cuts; // number of rays cut by --depth; those cut by --bailout from bit 16 on
    float cut; // sum of the largest channel of each weight that is not traced
    bool deep; // cut by --depth
    bool lost; // a weight is NaN: such a ray is not traced, so the sum must become NaN
};

// Whether a ray of this weight is traced; counts it as cut where it is not.
bool traced(vec3 weight, bool deep, inout Calls calls, inout uint status)
{
    float largest = largest_of(weight);
    calls.lost = calls.lost || any(isnan(weight));
    bool small = !(largest >= frame.bailout);
    bool counts = (deep || small) && largest > 0.0 && !must_wait(status);
    calls.cuts += counts ? (deep ? 1u : 1u << 16) : 0u;
    calls.cut += counts ? largest : 0.0;
    calls.deep = deep;
    return !deep && !small && !must_wait(status);
}

void call(uint which, vec3 dir, vec3 weight, bool deep, inout Calls calls, inout uint status)
{
    calls.dir[which] = dir;
    calls.weight[which] = weight;
    uint cuts = calls.cuts;
    calls.wanted[which] = traced(weight, deep, calls, status);
    if (SPEC_PROBE != 0u && calls.cuts != cuts)
        calls.ends[which] = deep ? PROBE_DEPTH : PROBE_BAILOUT;
}

// A user's scatter() may send rays of any kind, whatever the scene's materials do.
bool scatters()
{
    return CALLS_RAYS && (SPEC_HOOKS & HOOK_SCATTER) != 0u;
}

bool refracts()
{
    return SPEC_REFRACTION != 0u || scatters();
}

bool passes_straight()
{
    return SPEC_CUTOUTS != 0u || SPEC_CATCHERS != 0u || scatters();
}

// Calls the user's scatter(), or whit's of hook/scatter.glsl. `lost`: something that the user's
// function gave is NaN or infinite.
void scatter_hook(Surface s, Optics o, inout Rays rays, inout bool lost)
{
#ifdef HOOKS
    if ((SPEC_HOOKS & HOOK_SCATTER) != 0u) {
        begin_hook();
        scatter(s, o, rays);
        end_hook(true);
        vec3 sum = rays.reflected_dir + rays.refracted_dir + rays.reflected + rays.refracted + rays.straight;
        lost = lost || any(isnan(sum)) || any(isinf(sum));
        return;
    }
#endif
    whit_scatter(s, o, rays);
}

Calls no_calls(uint steps)
{
    Calls calls;
    calls.wanted[0] = calls.wanted[1] = calls.wanted[2] = false;
    calls.ends[0] = calls.ends[1] = calls.ends[2] = PROBE_DEFERRED;
    calls.cut = 0.0;
    calls.cuts = 0u;
    calls.lost = false;
    calls.steps = steps;
    return calls;
}

// The rays that the surface reflects, refracts and lets straight through.
Calls call_children(Ray ray, Surface s, Optics o, Crossing c, inout uint status)
{
    Calls calls = no_calls(ray.steps + STEPS_OF_BOUNCE);
    bool deep = SPEC_SECONDARY == 0u || ray_bounces(ray.steps) >= frame.depth;
    Rays rays = Rays(vec3(0.0), vec3(0.0), vec3(0.0), ray.dir, ray.dir);
    scatter_hook(s, o, rays, calls.lost);
    if (refracts()) {
        vec3 dir = rays.refracted_dir;
        // A shading normal may bend the ray back to its own side: then it goes straight on.
        if (dot(dir, s.ng) >= 0.0 || dot(dir, c.ng) >= 0.0)
            dir = ray.dir;
        call(0u, dir, ray.weight * rays.refracted, deep, calls, status);
    }
    if (passes_straight())
        call(1u, ray.dir, ray.weight * rays.straight, deep, calls, status);
    if (SPEC_REFLECTION != 0u) {
        vec3 dir = rays.reflected_dir;
        if (dot(dir, s.ng) <= 0.0)
            dir = reflect(ray.dir, s.ng);
        call(2u, normalize(dir), ray.weight * rays.reflected, deep, calls, status);
    }
    return calls;
}

// The ray that goes straight on where both sides of a surface are the same medium. It is counted as
// refracted.
Calls call_through(Ray ray, inout uint status)
{
    Calls calls = no_calls(ray.steps + 1u);
    bool deep = SPEC_SECONDARY == 0u || ray_bounces(calls.steps) > frame.depth;
    call(0u, ray.dir, ray.weight, deep, calls, status);
    return calls;
}

// The word that names the record on which a ray starts. `leaves`: see leaves_instance.
uint start_of_ray(uint record, bool leaves)
{
    return leaves ? record | RECORD_SKIPS_ALL : record;
}

// Puts a ray into the next generation.
void send(uint slot, Ray ray, vec3 dir, vec3 weight, uint steps, inout uint next)
{
    ray.dir = dir;
    ray.weight = weight;
    ray.steps = steps;
    store_ray(next, ray, slot);
    next++;
}

// Puts the called rays into the next generation. Returns the bits of sums[].w that name them.
uint send_calls(bool alive, Met met, Optics o, Calls calls, inout uint status)
{
    uint next = reserve_rays(alive ? uint(calls.wanted[0]) + uint(calls.wanted[1]) +
                                         uint(calls.wanted[2])
                                   : 0u,
                             status);
    uint sum = add_up_lanes(next != HIT_NONE ? uint(calls.wanted[0]) | uint(calls.wanted[2]) << 16 : 0u);
    if (is_first_lane() && (sum & 0xffffu) != 0u)
        atomicAdd(tally.refracted, sum & 0xffffu);
    if (is_first_lane() && sum >> 16 != 0u)
        atomicAdd(tally.reflected, sum >> 16);
    if (next == HIT_NONE)
        return 0u;
    uint has = next;
    Ray beyond = met.ray;
    beyond.origin = offset_origin(met.c.p, met.c.error, -met.c.ng);
    beyond.skip_instance = met.c.instance;
    beyond.skip_record = start_of_ray(met.c.record,
                                      leaves_instance(met.c.instance, met.c.outwards));
    if ((refracts() || SPEC_MEDIA != 0u) && calls.wanted[0]) {
        beyond.media = o.thin ? met.ray.media : met.c.after;
        beyond.kind = RAY_REFRACTED;
        send(met.slot, beyond, calls.dir[0], calls.weight[0], calls.steps, next);
        has |= SUM_REFRACTED;
    }
    if (passes_straight() && calls.wanted[1]) {
        beyond.media = met.ray.media;
        beyond.kind = met.ray.kind;
        send(met.slot, beyond, calls.dir[1], calls.weight[1], calls.steps, next);
        has |= SUM_STRAIGHT;
    }
    if (SPEC_REFLECTION != 0u && calls.wanted[2]) {
        Ray back = met.ray;
        back.origin = offset_origin(met.s.p, met.s.error, met.s.ng);
        back.skip_instance = met.hit.instance;
        back.skip_record = start_of_ray(met.hit.triangle,
                                        leaves_instance(met.hit.instance, !met.inside));
        back.media = met.c.before;
        back.kind = RAY_REFLECTED;
        send(met.slot, back, calls.dir[2], calls.weight[2], calls.steps, next);
        has |= SUM_REFLECTED;
    }
    return has;
}

void tally_cuts(uint cuts)
{
    cuts = add_up_lanes(cuts);
    if (is_first_lane() && (cuts & 0xffffu) != 0u)
        atomicAdd(tally.cut_depth, cuts & 0xffffu);
    if (is_first_lane() && cuts >> 16 != 0u)
        atomicAdd(tally.cut_bailout, cuts >> 16);
}

void probe_calls(uint id, Ray ray, Calls calls, uint has, bool through)
{
    uvec3 sent = child_ids(has);
    uint kinds[3] = uint[3](RAY_REFRACTED | (through ? PROBE_THROUGH : 0u), ray.kind | PROBE_STRAIGHT,
                            RAY_REFLECTED);
    for (uint i = 0u; i < 3u; i++) {
        if (calls.ends[i] != PROBE_DEFERRED)
            probe_cut_ray(id, kinds[i], calls.ends[i], calls.dir[i], calls.weight[i]);
        if (sent[i] != HIT_NONE)
            probe_sent(id, sent[i], kinds[i]);
    }
}

void count_cut(uint slot, Calls calls)
{
    atomicAdd(cuts[slot * 2u + uint(!calls.deep)], uint(min(calls.cut, 64.0) * CUT_PARTS + 0.5));
}

Lit lit_hit(uint id, Met met, Optics o, bool catcher)
{
    vec3 weight = catcher ? vec3(1.0) : met.ray.weight * (1.0 - o.straight);
    Lit lit = lit_surface(met.s, o, weight, met.c.before);
    lit.flags |= catcher ? LIT_CATCHER : 0u;
    lit.id = id;
    bool leaves = leaves_instance(met.hit.instance, !met.inside);
    lit.record = start_of_ray(met.hit.triangle, leaves);
    lit.view = -met.ray.dir;
    lit.skip_instance = met.hit.instance;
    lit.skip_primitive = leaves ? SKIP_ALL : met.hit.primitive;
    return lit;
}

// With SPEC_DIRECT: adds the light of all lights to `sum`, one after the other as the shadow stages
// do. Returns which lights are left to these, as bits: at NUMERICS_EXACT, the first one whose shadow
// ray is to be deferred, and those behind it.
uint add_direct_light(bool wanted, Lit lit, inout vec3 sum, inout uint status)
{
    uint left = 0u, i = 0u;
    do {
        gpu_light light = fetch_light(i);
        Arrival a = arrive(wanted && left == 0u, lit, light, 0u);
        Hit blocker = traverse(TRAVERSE_SHADOW, lit.origin, a.dir, 0.0, a.distance,
                               a.wanted ? frame.root : REF_DONE, lit.skip_instance,
                               a.above ? lit.skip_primitive : HIT_NONE);
        bool waits = a.wanted && must_wait(blocker.status), done = a.wanted && !waits;
        left = waits ? 0xffffffffu << i : left;
        sum += done ? a.reflected * a.arriving * passing_share(blocker, lit.absorption) : vec3(0.0);
        status |= done ? blocker.status : 0u;
        uint rays = add_up_lanes(uint(done));
        if (is_first_lane() && rays != 0u)
            atomicAdd(generations[chunk.generation].lists[LIST_LIGHTS + i].shadow_rays, rays);
        i++;
    } while (i < frame.light_count); // main() tells whether it was cut short
    return left;
}

// The light that the surface sends without that of lights; with a user's shade() all of its light.
vec3 emitted_light(uint id, Optics o)
{
    if ((SPEC_HOOKS & HOOK_SHADE) != 0u)
        return fetch_hook_light(id);
    return o.unlit ? o.diffuse + o.emission : o.emission + o.ambient * frame.ambient;
}

void main()
{
    load_frame();
#ifdef HOOKS
    begin_functions();
#endif
    bool waited = SPEC_NUMERICS == NUMERICS_EXACT && SPEC_SETTLES != 0u && chunk.deferred != 0u;
    uint item = waited ? deferred_item(0u) : invocation_item(0u, hit_capacity());
    bool alive = item != ITEM_NONE;
    item = alive ? item : 0u;
    uint id = waited ? item : fetch_listed_hit(item);
    id = alive ? id : 0u;
    uint status = 0u;
    Met met = fetch_met(id, alive, true, status);
    if (has_bounds_alone())
        list_deferred(alive && must_wait(status), id);
    alive = alive && !must_wait(status);
#ifdef HOOKS
    record_for(id, alive);
#endif
    bool lost = false;
    if ((SPEC_HOOKS & HOOK_SURFACE) != 0u)
        fetch_changed(id, met.s, lost);
    Optics o = look_at(met);
    bool seen = SPEC_MEDIA == 0u || met.c.seen, catcher = is_catcher(met);
    Calls calls = call_children(met.ray, met.s, o, met.c, status);
    if (SPEC_MEDIA != 0u && !seen) {
        calls = call_through(met.ray, status);
        o.thin = false;
    }
    vec3 emitted = emitted_light(id, o);
    calls.lost = calls.lost || lost;
#ifdef HOOKS
    status |= hook_status;
    if (has_bounds_alone())
        list_deferred(alive && must_wait(hook_status), id);
    alive = alive && !must_wait(hook_status);
    if (alive)
        tally_traced(hook_traced);
#endif
    if (CALLS_RAYS)
        tally_cuts(alive ? calls.cuts : 0u);
    uint has = 0u;
    if (SPEC_SECONDARY != 0u && CALLS_RAYS)
        has = send_calls(alive, met, o, calls, status);
    if (SPEC_PROBE != 0u && alive)
        probe_calls(id, met.ray, calls, has, !seen);
    emitted *= met.ray.weight * (1.0 - o.straight);
    bool some = has != 0u;
    has |= catcher && some ? SUM_IS_CATCHER : 0u;
    emitted = calls.lost ? vec3(uintBitsToFloat(0x7fc00000u)) : emitted;
    vec3 sum = calls.lost || (seen && !catcher) ? emitted : vec3(0.0);
    if (SPEC_DIRECT == 0u && alive)
        store_sum(id, sum, has);
    if (CALLS_RAYS && alive && calls.cut > 0.0)
        count_cut(met.slot, calls);
    if (alive && catcher)
        store_hit_row(id * HIT_ROWS, uvec4(0u));
    bool has_asked = (SPEC_HOOKS & HOOK_SHADE) != 0u; // by shade(), except for shadow catchers
    seen = has_asked ? catcher : seen;
    if (SPEC_LIGHTS != 0u && (SPEC_CATCHERS != 0u || (SPEC_HOOKS & HOOK_SHADE) == 0u)) {
        Lit lit = lit_hit(id, met, o, catcher);
        vec3 reflects = lit.diffuse + lit.highlight;
        bool asks = alive && seen && !o.unlit && (!catcher || some) &&
                    (largest_of(reflects) > 0.0 || any(isnan(reflects)));
        uint lights = 0xffffffffu;
        if (SPEC_DIRECT != 0u)
            lights = add_direct_light(asks, lit, sum, status);
        if (SPEC_DIRECT == 0u || has_bounds_alone())
            list_lit(asks, lights, lit, status);
        if (SPEC_DIRECT != 0u && !loops_go_on(frame.light_count + 1u))
            status |= STATUS_UNFINISHED_LOOP;
    }
    if (SPEC_DIRECT != 0u && alive)
        store_sum(id, sum, has);
    report_status(alive ? status : 0u);
#ifdef HOOKS
    if (alive)
        report_hooks();
#endif
}

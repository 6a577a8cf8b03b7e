// Finds where rays meet a user's shape: rays of a generation before they go through the trees
// (closest.comp keeps the shape where it comes first), and shadow rays to a light, which the shape
// may block (shadow.comp). It is a small kernel of its own, so that a changed file compiles fast.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../bind/stage.glsl"
#include "../bind/queues.glsl"
#include "../bind/arrival.glsl"
#include "../hook/declare.glsl"

// A ray to test against the shape.
struct ShapeRay {
    bool alive;
    uint at; // its id; of a shadow ray, its hit's place in the light's list
    vec3 origin, dir;
    float t_max;
};

// Returns this invocation's ray of the generation. The shape's answers to camera rays of the first
// sample are checked (shape_checked).
ShapeRay generation_ray()
{
    uint id = traced_item(0u), slot;
    ShapeRay asked;
    asked.alive = id != ITEM_NONE;
    asked.at = asked.alive ? id : 0u;
    record_for(asked.at, false); // closest.comp records dbg(x) of camera()
    Ray ray = fetch_ray(asked.at, slot);
    count_camera(0u, is_primary());
    uvec2 pixel = slot_pixel(slot);
    hook_pixel = pixel;
    hook_ray = ray;
    asked.alive = asked.alive && (!is_primary() || is_in_picture(slot_place(slot)));
    asked.origin = ray.origin;
    asked.dir = ray.dir;
    asked.t_max = FLOAT_LARGEST;
    bool checked = asked.alive && is_primary() && chunk.sample_index == 0u;
    shape_checked = checked ? pixel.y * frame.width + pixel.x + 1u : 0u;
    record_for(asked.at, asked.alive);
    return asked;
}

// The shadow ray from the invocation's lit hit `r` to a point of the light.
ShapeRay shadow_ray(gpu_light light, uint r, uint rays, uint point)
{
    uint place = gl_LocalInvocationID.x + r * SPEC_GROUP_SIZE;
    uint item = listed_item(place, rays * SPEC_GROUP_SIZE, chunk.lit_capacity);
    ShapeRay asked;
    asked.alive = item != ITEM_NONE;
    asked.at = asked.alive ? item : 0u;
    uint index = fetch_listed_lit(asked.at);
    Lit lit = fetch_lit(asked.alive ? index : 0u);
    Arrival a = arrive(asked.alive, lit, light, point);
    uint slot;
    hook_ray = fetch_ray(lit.id, slot);
    hook_ray.origin = lit.origin;
    hook_ray.dir = a.dir;
    hook_pixel = slot_pixel(slot);
    asked.alive = a.wanted;
    asked.origin = lit.origin;
    asked.dir = a.dir;
    asked.t_max = a.distance;
    return asked;
}

// One loop serves both kinds of rays, so that the user's function is in the kernel only once.
void main()
{
    load_frame();
    begin_functions();
    bool to_light = SPEC_SHADOWS != 0u && SPEC_LIGHTS != 0u && chunk.list != LIST_RAYS;
    gpu_light light = fetch_light(to_light ? chunk.light : 0u);
    uint rays = to_light && is_primary() ? SPEC_LIT_RAYS : 1u;
    uint points = to_light && is_flat(light) ? turns_each() : 1u;
    uint turn = 0u, shadows = 0u;
    bool more = false;
    do {
        uint r = turn / points, point = turn - r * points;
        ShapeRay asked;
        if (to_light)
            asked = shadow_ray(light, r, rays, point);
        else
            asked = generation_ray();
        Hit hit = make_hit(asked.t_max);
        add_shape(asked.origin, asked.dir, asked.alive && is_usable(asked.origin, asked.dir), hit);
        bool met = hit.primitive != HIT_NONE;
        if (!to_light && asked.alive)
            store_shape(asked.at, hit);
        shadows = (point & 31u) == 0u ? uint(met) : shadows | uint(met) << (point & 31u);
        if (to_light && asked.alive)
            store_shape_shadows(asked.at, point >> 5, shadows);
        turn++;
        more = turn < rays * points;
    } while (another_iteration(more));
    if (more)
        report_status(STATUS_UNFINISHED_LOOP);
    report_status(hook_status);
    tally_traced(hook_traced);
    report_hooks();
}

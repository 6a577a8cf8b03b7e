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

// The shadow ray from the invocation's lit hit `r` to a point of the light, whether or not the surface
// reflects enough of the light to be traced: that is not worth the material's rows here.
ShapeRay shadow_ray(gpu_light light, uint r, uint rays, uint point)
{
    uint place = gl_LocalInvocationID.x + r * SPEC_GROUP_SIZE;
    uint item = listed_item(place, rays * SPEC_GROUP_SIZE, chunk.lit_capacity);
    ShapeRay asked;
    asked.alive = item != ITEM_NONE;
    asked.at = asked.alive ? item : 0u;
    uint index = fetch_listed_lit(asked.at);
    Lit lit = fetch_lit(asked.alive ? index : 0u);
    LightSample at;
    Arrival a;
    asked.alive = aim_from_surface(asked.alive, lit, light, point, at, a);
    uint slot;
    hook_ray = fetch_ray(lit.id, slot);
    hook_ray.origin = lit.origin;
    hook_ray.dir = a.dir;
    hook_pixel = slot_pixel(slot);
    asked.origin = lit.origin;
    asked.dir = a.dir;
    asked.t_max = a.distance;
    return asked;
}

Hit meet_shape(ShapeRay asked)
{
    Hit hit = make_hit(asked.t_max);
    add_shape(asked.origin, asked.dir, asked.alive && is_usable(asked.origin, asked.dir), hit);
    return hit;
}

// Asks for each point of the light.
void ask_to_light()
{
    gpu_light light = fetch_light(chunk.light);
    uint rays = is_primary() ? SPEC_LIT_RAYS : 1u, points = is_flat(light) ? turns_each() : 1u;
    uint turn = 0u, shadows = 0u;
    bool more = false;
    do {
        uint r = turn / points, point = turn - r * points;
        ShapeRay asked = shadow_ray(light, r, rays, point);
        bool met = meet_shape(asked).primitive != HIT_NONE;
        shadows = (point & 31u) == 0u ? uint(met) : shadows | uint(met) << (point & 31u);
        if (asked.alive)
            store_shape_shadows(asked.at, point >> 5, shadows);
        turn++;
        more = turn < rays * points;
    } while (another_iteration(more));
    if (more)
        report_status(STATUS_UNFINISHED_LOOP);
}

void main()
{
    load_frame();
    begin_functions();
    if (SPEC_ANY_HIT != 0u) {
        ask_to_light();
    } else {
        ShapeRay asked = generation_ray();
        Hit hit = meet_shape(asked);
        if (asked.alive)
            store_shape(asked.at, hit);
    }
    report_status(hook_status);
    tally_traced(hook_traced);
    report_hooks();
}

// Calls the user's miss() for the rays of a generation that hit nothing. It is a small kernel of
// its own, so that a changed file compiles fast.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../bind/stage.glsl"
#include "../bind/probe.glsl"
#include "../bind/queues.glsl"
#include "../hook/declare.glsl"

void main()
{
    load_frame();
    begin_functions();
    uint id = traced_item(0u);
    id = id == ITEM_NONE ? 0u : id;
    vec4 own = fetch_sum(id);
    bool alive = traced_item(0u) != ITEM_NONE && floatBitsToUint(own.w) == SUM_MISSED;
    uint slot;
    hook_ray = fetch_ray(id, slot);
    count_camera(0u, is_primary());
    alive = alive && (!is_primary() || is_in_picture(slot_pixel(slot)));
    hook_pixel = slot_pixel(slot);
    hook_hit = make_hit(FLOAT_LARGEST);
    record_for(id, alive);
    begin_hook();
    vec3 sky = miss(hook_ray.dir) * own.rgb;
    end_hook(alive);
    if (alive)
        store_sum(id, sky, 0u);
    if (SPEC_PROBE != 0u && alive)
        probe_added(id, sky, false);
    if (alive) {
        report_status(hook_status);
        tally_traced(hook_traced);
    }
    report_hooks();
}

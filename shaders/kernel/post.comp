// Calls the user's post() for the colour of each pixel that has all its samples. It has a kernel of
// its own, so that a changed file compiles fast, and draws the last picture's pixels again without
// tracing rays.
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
    uint id = camera_item(0u);
    uint slot = id == ITEM_NONE ? 0u : id;
    uvec2 at = slot_place(slot);
    bool alive = id != ITEM_NONE && is_tile_done() && is_in_picture(at);
    uint pixel = alive ? (at.y - chunk.band_y) * frame.width + at.x : 0u;
    hook_pixel = slot_pixel(slot);
    hook_ray.origin = frame.eye;
    hook_records = alive; // called once for all samples of the pixel
    hook_id = id;
    begin_hook();
    vec3 color = post(ivec2(hook_pixel), pixels[chunk.before_post + pixel].rgb);
    end_hook(alive);
    if (alive) {
        if (any(isnan(color)) || any(isinf(color)))
            report_status(STATUS_NON_FINITE);
        pixels[pixel] = vec4(color, 1.0);
        report_status(hook_status);
        tally_traced(hook_traced);
    }
    report_hooks();
}

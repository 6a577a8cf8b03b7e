// Calls the aov functions of a user's file for the hits of camera rays. They have a kernel of their
// own, so that a changed file compiles fast, and leaves the colours as they are.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../bind/stage.glsl"
#include "../bind/queues.glsl"
#include "../hook/declare.glsl"
#include "../hook/met.glsl"

void main()
{
    load_frame();
    begin_functions();
    uint item = invocation_item(0u, hit_capacity());
    bool alive = item != ITEM_NONE;
    uint id = fetch_listed_hit(alive ? item : 0u);
    id = alive ? id : 0u;
    uint status = 0u; // shade.comp reports it
    Met met = fetch_met(id, alive, false, status);
    bool lost = false; // shade.comp reports it
    if ((SPEC_HOOKS & HOOK_SURFACE) != 0u)
        fetch_changed(id, met.s, lost);
    look_at(met);
    record_for(id, alive); // closest.comp records dbg(x) of camera(), hit.comp that of surface()
    for (uint i = 0u; i < SPEC_AOVS; i++) {
        begin_hook();
        vec4 value = aov(i, met.s);
        end_hook(true);
        if (alive)
            aovs[met.slot * SPEC_AOVS + i] = value;
    }
    if (alive) {
        report_status(hook_status);
        tally_traced(hook_traced);
        report_hooks();
    }
}

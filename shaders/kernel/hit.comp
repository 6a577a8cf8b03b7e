// Calls the user's surface() and shade() for the hits of a generation. They have a kernel of their
// own, before the one that shades, so that a changed file compiles fast.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../bind/stage.glsl"
#include "../bind/queues.glsl"
#include "../hook/declare.glsl"
#include "../hook/met.glsl"

// Calls surface(). Fields that it may not change stay as they are, and so does the normal where it
// gives none with a direction.
void change_surface(uint id, bool alive, inout Surface s)
{
    Surface changed = s;
    begin_hook();
    surface(changed);
    end_hook(true);
    vec3 sum = changed.ns + changed.color + vec3(changed.u, changed.v, changed.color_alpha);
    bool lost = any(isnan(sum)) || any(isinf(sum));
    if (changed.ns != s.ns) // else its bits stay, and with them the picture
        s.ns = normalize_or(changed.ns, s.ns);
    s.color = changed.color;
    s.color_alpha = changed.color_alpha;
    s.u = changed.u;
    s.v = changed.v;
    if (alive)
        store_changed(id, s, lost);
}

// HIT_PART_FETCH: stores what the user's functions need. Without room for it the tile is drawn
// again in smaller ones.
void fetch_for_functions(uint id, bool alive)
{
    uint row, status = 0u;
    bool has_room = met_row(row);
    Met met = fetch_met(id, alive, false, status);
    Optics o = look_at(met);
    if (alive && has_room) {
        store_met(row, met);
        store_optics(row, o);
    }
    if (alive && !has_room)
        report_status(STATUS_QUEUE_FULL);
}

// Calls the user's functions. `row`: where HIT_PART_CALL finds what HIT_PART_FETCH stored.
void call_functions(uint id, bool alive, uint row)
{
    const bool stored = SPEC_HIT_PART == HIT_PART_CALL;
    uint status = 0u;      // shade.comp fetches the same and reports it; here it is not used
    record_for(id, false); // closest.comp records dbg(x) of camera()
    Met met;
    if (stored) {
        met = fetch_stored_met(row);
        met.hit = fetch_hit(id);
        tell_functions(met);
    } else {
        met = fetch_met(id, alive, false, status);
    }
    record_for(id, alive);
    if ((SPEC_HOOKS & HOOK_SURFACE) != 0u)
        change_surface(id, alive, met.s);
    if ((SPEC_HOOKS & HOOK_SHADE) != 0u) {
        Optics o;
        if (stored)
            o = fetch_optics(row);
        else
            o = look_at(met);
        begin_hook();
        vec3 light = shade(met.s, o, -met.ray.dir);
        end_hook(true);
        if (alive)
            store_hook_light(id, light);
    }
    if (alive) {
        report_status(hook_status);
        tally_traced(hook_traced);
        report_hooks();
    }
}

void main()
{
    load_frame();
    begin_functions();
    uint item = invocation_item(0u, hit_capacity()), row = 0u;
    bool alive = item != ITEM_NONE;
    uint id = fetch_listed_hit(alive ? item : 0u);
    id = alive ? id : 0u;
    if (SPEC_HIT_PART == HIT_PART_FETCH) {
        fetch_for_functions(id, alive);
    } else {
        if (SPEC_HIT_PART == HIT_PART_CALL)
            alive = met_row(row) && alive;
        call_functions(id, alive, row);
    }
}

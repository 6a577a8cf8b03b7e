// What a user's functions make of what a ray has met: the surface, and the light that it sends to the eye. In a
// kernel of its own, before the one that shades, so that the file's next version is soon made.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#include "../bind/queues.glsl"
#include "../hook/declare.glsl"
#include "../hook/met.glsl"

layout(local_size_x_id = 0) in;

// Fields of the surface that surface() may not change stay; a normal that is no direction does too.
void change_surface(uint id, bool alive, inout Surface s)
{
    Surface changed = s;
    begin_hook();
    surface(changed);
    end_hook(true);
    vec3 sum = changed.ns + changed.color + vec3(changed.u, changed.v, changed.color_alpha);
    bool lost = any(isnan(sum)) || any(isinf(sum));
    s.ns = normalize_or(changed.ns, s.ns);
    s.color = changed.color;
    s.color_alpha = changed.color_alpha;
    s.u = changed.u;
    s.v = changed.v;
    if (alive)
        store_changed(id, s, lost);
}

void main()
{
    load_frame();
    begin_user();
    uint item = invocation_item(0u, hit_capacity());
    bool alive = item != ITEM_NONE;
    uint id = fetch_listed_hit(alive ? item : 0u);
    id = alive ? id : 0u;
    uint status = 0u;      // shade.comp reports it: what is not read here of the way through is not compiled
    record_for(id, false); // values of dbg(x) in camera() are recorded by closest.comp
    Met met = fetch_met(id, alive, false, status);
    record_for(id, alive);
    if ((SPEC_HOOKS & HOOK_SURFACE) != 0u)
        change_surface(id, alive, met.s);
    if ((SPEC_HOOKS & HOOK_SHADE) != 0u) {
        Optics o = look_at(met);
        begin_hook();
        vec3 light = shade(met.s, o, -met.ray.dir);
        end_hook(true);
        if (alive)
            store_hook_light(id, light);
    }
    if (alive) {
        report_status(hook_status);
        report_hooks();
        tally_traced(hook_traced);
    }
}

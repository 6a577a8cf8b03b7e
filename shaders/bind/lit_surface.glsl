// Makes the lit hit of a surface.
#ifndef BIND_LIT_SURFACE_GLSL
#define BIND_LIT_SURFACE_GLSL

#include "filter.glsl"
#include "lit.glsl"
#include "optics.glsl"
#include "terminator.glsl"

// The record of a surface for the shadow kernel. `weight`: of its light; `media`: around it. The
// caller sets what belongs to the ray: view, id, record, and what the shadow ray skips.
Lit lit_surface(Surface s, Optics o, vec3 weight, uvec4 media)
{
    vec3 lift = smooth_lift(s);
    Lit lit;
    lit.p = s.p;
    lit.origin = offset_origin(s.p + lift, s.error, s.ng);
    lit.error = max(s.error.x, max(s.error.y, s.error.z));
    lit.ns = s.ns;
    lit.ng = s.ng;
    lit.view = vec3(0.0);
    lit.diffuse = o.diffuse * weight;
    lit.highlight = o.highlight * weight;
    lit.gloss = o.metal_rough ? o.alpha : o.shininess;
    lit.absorption = surrounding_absorption(media);
    lit.flags = (lift != vec3(0.0) ? LIT_LIFTED : 0u) | (o.metal_rough ? LIT_METAL_ROUGH : 0u);
    return lit;
}

#endif

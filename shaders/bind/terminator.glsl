// Moves the start of shadow rays on smooth meshes of few triangles, which would otherwise shade
// themselves along the edges of their triangles (the shadow terminator).
#ifndef BIND_TERMINATOR_GLSL
#define BIND_TERMINATOR_GLSL

#include "surface.glsl"

// The least cosine between a vertex normal and the triangle's normal on a smooth surface. A box
// with normals averaged at its corners is not smooth: the smooth surface would be far outside it.
const float SMOOTH_COSINE = 0.70710678;

vec3 vertex_normal(Surface s, uint corner)
{
    uint row = frame.triangle_row + s.shade_index * TRIANGLE_SHADE_ROWS + corner;
    vec3 n = row_vec3(fetch_shading_row(row));
    if (SPEC_INSTANCED != 0u || SPEC_FLAT != 0u)
        n = place_normal(fetch_instance_frame(s.instance == HIT_SHAPE ? 0u : s.instance), n);
    return normalize_or(n, vec3(0.0));
}

// How far a point at `from` relative to a vertex is below the tangent plane there, as a vector
// along the plane's normal on the side of ng. `slack`: what rounding may do to flat meshes.
vec3 lift_to_plane(vec3 from, vec3 n, vec3 ng, float slack, inout bool smooth_mesh)
{
    float cosine = dot(n, ng);
    n = cosine < 0.0 ? -n : n;
    smooth_mesh = smooth_mesh && abs(cosine) >= SMOOTH_COSINE;
    return n * max(-dot(from, n) - slack, 0.0);
}

// The vector from the hit point to the smooth surface, outwards only: to the mean of the point's
// projections on the tangent planes at the vertices (Hanika 2021, "Hacking the Shadow Terminator",
// Ray Tracing Gems II, chapter 4). Zero on flat meshes, on concave sides and on spheres. `s` faces
// the ray; where media touch it may be another surface than the one that was hit first.
vec3 smooth_lift(Surface s)
{
    if (SPEC_TERMINATOR == 0u || SPEC_SMOOTH_NORMALS == 0u || SPEC_SPHERES == SPHERES_ONLY)
        return vec3(0.0);
    vec3 from0 = s.e1 * s.u + s.e2 * s.v;
    vec3 size = max(abs(s.e1), abs(s.e2));
    float slack = max(size.x, max(size.y, size.z)) * (1.0 / 65536.0);
    bool smooth_mesh = (SPEC_SPHERES == SPHERES_NONE && (SPEC_HOOKS & HOOK_INTERSECT) == 0u) || !s.on_sphere;
    vec3 lift0 = lift_to_plane(from0, vertex_normal(s, 0u), s.ng, slack, smooth_mesh);
    vec3 lift1 = lift_to_plane(from0 - s.e1, vertex_normal(s, 1u), s.ng, slack, smooth_mesh);
    vec3 lift2 = lift_to_plane(from0 - s.e2, vertex_normal(s, 2u), s.ng, slack, smooth_mesh);
    vec3 lift = lift0 * (1.0 - s.u - s.v) + lift1 * s.u + lift2 * s.v;
    return smooth_mesh ? lift : vec3(0.0);
}

#endif

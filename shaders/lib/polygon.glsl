// The form factor of a polygon of uniform radiance.
#ifndef LIB_POLYGON_GLSL
#define LIB_POLYGON_GLSL

#include "angles.glsl"
#include "spawn.glsl"

const float POLYGON_PI = 3.14159265358979;

// The term of the edge from a to b in the form factor: the angle between a and b, times the cosine
// between n and the normal of their plane (Lambert 1760; Arvo 1995, "Applications of irradiance
// tensors", section 4).
float edge_term(vec3 n, vec3 a, vec3 b)
{
    vec3 reach = max(abs(a), abs(b));
    float scale = max(max(reach.x, max(reach.y, reach.z)), 1.17549435e-38);
    a /= scale;
    b /= scale;
    // a x b. In b - a less cancels where the edge is short; where one end is far away, the other one is
    // lost in b - a, and must be the factor.
    vec3 normal = dot(a, a) > dot(b, b) ? cross(a - b, b) : cross(a, b - a);
    float size = length(normal);
    return size > 0.0 ? angle_of(dot(a, b), size) * dot(n, normal) / size : 0.0;
}

// The term of the part of an edge above the horizon. Also finds the points where the outline goes
// below the horizon and comes back.
float clipped_edge_term(vec3 n, vec3 a, vec3 b, float a_height, float b_height, inout vec3 leaves,
                        inout vec3 returns)
{
    bool a_up = a_height > 0.0, b_up = b_height > 0.0;
    bool swap = dot(a, a) > dot(b, b); // from the nearer end, as the other one has larger roundings
    vec3 near = swap ? b : a, far = swap ? a : b;
    float height = swap ? b_height : a_height, across = height - (swap ? a_height : b_height);
    vec3 met = near + (far - near) * (across != 0.0 ? height / across : 0.0);
    leaves = a_up && !b_up ? met : leaves;
    returns = !a_up && b_up ? met : returns;
    return a_up || b_up ? edge_term(n, a_up ? a : met, b_up ? b : met) : 0.0;
}

// Form factor from a point with unit normal `n` to a convex polygon of four corners, given relative
// to the point (a triangle repeats one): irradiance = pi * radiance * form factor. The polygon is
// cut at the horizon of `n`. The sign tells the winding. Relative error: about 1e-6 * distance /
// size; 1e-6 where the polygon is larger than its distance.
float polygon_form_factor(vec3 n, vec3 c0, vec3 c1, vec3 c2, vec3 c3)
{
    vec4 h = vec4(dot(n, c0), dot(n, c1), dot(n, c2), dot(n, c3));
    vec3 leaves = vec3(0.0), returns = vec3(0.0);
    float sum = clipped_edge_term(n, c0, c1, h.x, h.y, leaves, returns);
    sum += clipped_edge_term(n, c1, c2, h.y, h.z, leaves, returns);
    sum += clipped_edge_term(n, c2, c3, h.z, h.w, leaves, returns);
    sum += clipped_edge_term(n, c3, c0, h.w, h.x, leaves, returns);
    sum += edge_term(n, leaves, returns); // along the horizon
    return sum * (-0.5 / POLYGON_PI);
}

#endif

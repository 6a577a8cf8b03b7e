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
    vec3 normal = cross(a, b - a); // b - a, as less cancels where the edge is short
    float size = length(normal);
    return size > 0.0 ? angle_of(dot(a, b), size) * dot(n, normal) / size : 0.0;
}

// The term of the part of an edge above the horizon. Also finds the points where the outline goes
// below the horizon and comes back.
float clipped_edge_term(vec3 n, vec3 a, vec3 b, float a_height, float b_height, inout vec3 leaves,
                        inout vec3 returns)
{
    bool a_up = a_height > 0.0, b_up = b_height > 0.0;
    float across = a_height - b_height;
    vec3 met = a + (b - a) * (across != 0.0 ? a_height / across : 0.0);
    leaves = a_up && !b_up ? met : leaves;
    returns = !a_up && b_up ? met : returns;
    return a_up || b_up ? edge_term(n, a_up ? a : met, b_up ? b : met) : 0.0;
}

// Form factor from a point with unit normal `n` to a convex polygon of four corners, given relative
// to the point (a triangle repeats one): irradiance = pi * radiance * form factor. The polygon is
// cut at the horizon of `n`. The sign tells the winding. Relative error: about 1e-6 * distance /
// size.
float polygon_form_factor(vec3 n, vec3 c0, vec3 c1, vec3 c2, vec3 c3)
{
    vec3 reach = max(max(abs(c0), abs(c1)), max(abs(c2), abs(c3)));
    float scale = max(reach.x, max(reach.y, reach.z));
    if (!(scale > 0.0))
        return 0.0;
    c0 /= scale;
    c1 /= scale;
    c2 /= scale;
    c3 /= scale;
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

// NUMERICS_FAST: Moeller and Trumbore 1997, "Fast, minimum storage ray/triangle intersection",
// without an epsilon on the determinant. Neighbours round a shared edge each in its own way, so
// rays leak. twin/moller.h is this file in C.
#ifndef LIB_MOLLER_GLSL
#define LIB_MOLLER_GLSL

vec3 cross_product(vec3 a, vec3 b)
{
    precise vec3 n;
    n.x = a.y * b.z - a.z * b.y;
    n.y = a.z * b.x - a.x * b.z;
    n.z = a.x * b.y - a.y * b.x;
    return n;
}

float dot_in_order(vec3 a, vec3 b)
{
    precise float sum = (a.x * b.x + a.y * b.y) + a.z * b.z;
    return sum;
}

// Vertices are not relative to the origin. `front`: as in intersect_triangle.
bool intersect_moller(vec3 origin, vec3 dir, vec3 v0, vec3 v1, vec3 v2, float t_min, out float t,
                      out float u, out float v, out bool front)
{
    precise vec3 e1 = v1 - v0;
    precise vec3 e2 = v2 - v0;
    precise vec3 from = origin - v0;
    vec3 p = cross_product(dir, e2);
    float det = dot_in_order(e1, p);
    precise float inv_det = 1.0 / det;
    vec3 q = cross_product(from, e1);
    precise float weight_b = dot_in_order(from, p) * inv_det;
    precise float weight_c = dot_in_order(dir, q) * inv_det;
    precise float at = dot_in_order(e2, q) * inv_det;
    precise float weights = weight_b + weight_c;
    t = at;
    u = weight_b;
    v = weight_c;
    front = det > 0.0;
    return det != 0.0 && weight_b >= 0.0 && weight_c >= 0.0 && weights <= 1.0 && at >= t_min;
}

#endif

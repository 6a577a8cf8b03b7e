/* shaders/lib/moller.glsl in C, operation by operation: see there. */
#ifndef TWIN_MOLLER_H
#define TWIN_MOLLER_H

#include <stdbool.h>

#include "base/vec.h"

static inline bool intersect_moller(struct vec3 origin, struct vec3 dir, struct vec3 v0,
                                    struct vec3 v1, struct vec3 v2, float t_min, float *t, float *u,
                                    float *v)
{
    struct vec3 e1 = vec3_sub(v1, v0), e2 = vec3_sub(v2, v0), from = vec3_sub(origin, v0);
    struct vec3 p = vec3_cross(dir, e2);
    float det = vec3_dot(e1, p);
    float inv_det = 1.0f / det;
    struct vec3 q = vec3_cross(from, e1);
    *u = vec3_dot(from, p) * inv_det;
    *v = vec3_dot(dir, q) * inv_det;
    *t = vec3_dot(e2, q) * inv_det;
    return det != 0.0f && *u >= 0.0f && *v >= 0.0f && *u + *v <= 1.0f && *t >= t_min;
}

#endif

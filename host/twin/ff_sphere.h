/* shaders/lib/ff_sphere.glsl in C, bit for bit: the result of exact_meet_sphere() in float-float
   arithmetic, wherever its error bound leaves no doubt. Bounds: docs/numerics-method.md, "exact".
 */
#ifndef TWIN_FF_SPHERE_H
#define TWIN_FF_SPHERE_H

#include "twin/exact_sphere.h"

/* Like exact_meet_sphere(). False: float-floats cannot decide, and *out is undefined. */
bool ff_meet_sphere(struct vec3 origin, struct vec3 dir, struct vec3 center, float radius,
                    bool only_far, float t_min, struct sphere_candidate *out);

#endif

/* shaders/lib/ff_triangle.glsl in C, bit for bit: the result of exact_meet() in float-float
   arithmetic (ff_numbers.h), wherever its error bound leaves no doubt. Bounds:
   docs/numerics-method.md, "exact". */
#ifndef TWIN_FF_TRIANGLE_H
#define TWIN_FF_TRIANGLE_H

#include "twin/exact.h"

/* All coordinates must be finite. False: float-floats cannot decide, and *out is undefined; but
   with *key_known, out->key is the key if the triangle is hit. */
bool ff_meet(struct vec3 origin, struct vec3 dir, struct vec3 v0, struct vec3 v1, struct vec3 v2,
             struct exact_candidate *out, bool *key_known);

#endif

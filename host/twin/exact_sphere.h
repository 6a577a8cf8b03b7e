/* shaders/lib/exact_sphere.glsl in C: whether and where a ray meets a sphere, as exact arithmetic
   on the given floats would find. The filter repeats the shader's operations one by one; the exact
   test is the same integer arithmetic. Method and bounds: docs/numerics-method.md, "exact". */
#ifndef TWIN_EXACT_SPHERE_H
#define TWIN_EXACT_SPHERE_H

#include "twin/sphere.h"

/* The part of the answer that floats can decide. Keys are the exact t of the ends of the chord,
   rounded to nearest. */
struct sphere_bounds {
    bool outside;                           /* surely missed */
    bool inside;                            /* surely hit, and the chord's values are valid */
    bool inward_known;                      /* the chord's `inward` is certain */
    float near_lo, near_hi, far_lo, far_hi; /* bounds of the keys, if it is hit */
    float room_error;                       /* error bound of the foot's `room` */
};

void bound_sphere(const struct ray_setup *ray, struct vec3 center, float radius,
                  struct sphere_bounds *out);

struct sphere_candidate {
    bool met;     /* at t >= 0; false where the key exceeds FLT_MAX */
    bool at_exit; /* hit at the far end */
    bool inward;  /* where it is hit: the centre is ahead of the ray's origin */
    float key;    /* where it is met */
};

/* Where the ray meets the sphere: the nearer end of its chord that is at t >= 0 and whose key (t
   rounded to the nearest float) is at least `t_min`, which must be >= 0. `only_far`: only the far
   end is considered. All arguments are finite, radius > 0. */
void exact_meet_sphere(struct vec3 origin, struct vec3 dir, struct vec3 center, float radius,
                       bool only_far, float t_min, struct sphere_candidate *out);

#endif

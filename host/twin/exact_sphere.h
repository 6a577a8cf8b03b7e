/* shaders/lib/exact_sphere.glsl in C: whether a ray meets a sphere and where, as exact arithmetic
   says for the given floats. The filter is the shader's operation by operation, the exact test the
   same integers. Method and bounds: docs/numerics.md, "exact". */
#ifndef TWIN_EXACT_SPHERE_H
#define TWIN_EXACT_SPHERE_H

#include "twin/sphere.h"

/* What floats can tell. Keys are the exact t of the ends of the chord, rounded to nearest. */
struct sphere_bounds {
    bool outside;                           /* surely missed */
    bool inside;                            /* surely met, and what the chord says is good */
    bool inward_known;                      /* what the chord says of it is so */
    float near_lo, near_hi, far_lo, far_hi; /* of the keys, if it is met */
    float room_error;                       /* the room is not off by more */
};

void bound_sphere(const struct ray_setup *ray, struct vec3 center, float radius,
                  struct sphere_bounds *out);

struct sphere_candidate {
    bool met;     /* at t >= 0; false where the key exceeds FLT_MAX */
    bool at_exit; /* at the far end */
    bool inward;  /* where it is met: from the ray's origin the centre is ahead */
    float key;    /* where it is met */
};

/* Where the ray meets the sphere: the nearer end of its chord that is at t >= 0 and whose key (t
   rounded to the nearest float) is at least `t_min`, which must be >= 0. `only_far`: only the far
   end is considered. All arguments are finite, radius > 0. */
void exact_meet_sphere(struct vec3 origin, struct vec3 dir, struct vec3 center, float radius,
                       bool only_far, float t_min, struct sphere_candidate *out);

#endif

/* Hits of a ray with triangles and spheres by exact arithmetic, for the floats as they are given:
   the answers that the level `exact` is held against. Integers of any size (GMP) decide;
   with a filter in double before them where many rays are traced.

   The triangle, with its vertices a, b, c relative to the origin, is met when

       e_a = d.(b x c),   e_b = d.(c x a),   e_c = d.(a x b)

   are all >= 0 or all <= 0 and D = e_a + e_b + e_c is not 0: the line of the ray meets the closed
   triangle in one point (a line in its plane meets none or many, and one without area has no D).
   That point is at t = N / D, N = a.(b x c), with barycentrics e / D (Cramer's rule). Its key is t
   rounded to float, to nearest, ties to even, denormals too, and without a sign if it is 0; where
   that overflows there is no hit. A key counts from t_min to t_max, both included. Hits are in the
   order of (key, instance, primitive).

   Of a sphere with centre c and radius r, with m = c - origin, the line of the ray meets

       P t^2 - 2 S t + Q = 0,   P = d.d,  S = m.d,  Q = m.m - r^2

   where that has roots: in a near end and a far one, which are the same where the line touches. An
   end before the origin (t < 0) is not there; nor is one whose key would be infinite. Keys are
   those of triangles: t, now a root, rounded to float. Of ends that count the near one is hit, else
   the far one: the first in the order, or the first behind a known hit.

   In an instance the ray is what accel_local_ray makes of it, roundings and all. */
#ifndef ORACLE_RATIONAL_H
#define ORACLE_RATIONAL_H

#include "accel/accel.h"
#include "base/vec.h"

struct rational_hit {
    float t;                      /* the key; infinity: miss */
    uint32_t primitive, instance; /* HIT_NONE: miss */
    uint32_t edges; /* number of edges that the point is on: 0 inside, 1, or 2 at a vertex */
};

/* The hit that rational_trace looks for; zeroed: the closest hit. */
struct rational_query {
    bool any;                          /* any hit, not the closest */
    bool brute;                        /* no tree and no filter: integers for every primitive */
    const struct rational_hit *behind; /* the first hit that comes after this one */
    /* The hit where the ray starts; NULL: none. Its primitive is not hit again, except a sphere at
       its far end, where the ray goes into it (S > 0). With `behind` a sphere is tested as any
       other. */
    const struct rational_hit *own;
};

/* Scratch numbers for the functions below, for one thread at a time. `accel` is borrowed; it may be
   NULL if only rational_meet and rational_meet_sphere are called. After accel_pose, create a new
   one. NULL: no memory. */
struct rational *rational_create(const struct accel *accel);
void rational_destroy(struct rational *rational);

/* Whether the line of the ray meets the triangle, and the key and edges of the point, regardless of
   t_min and t_max. All numbers must be finite. `edges` may be NULL. */
bool rational_meet(struct rational *rational, struct vec3 origin, struct vec3 dir,
                   const struct vec3 v[3], float *key, uint32_t *edges);

/* The two ends of the chord in which the line of a ray meets a sphere. */
struct rational_chord {
    bool near_there, far_there;
    float near_key, far_key; /* set for an end that is there */
    bool inward;             /* S > 0: a ray that starts on the sphere goes into it */
};

/* Whether any end is there, regardless of t_min and t_max; *out is only set if the line meets the
   sphere. All numbers must be finite, `dir` not 0. */
bool rational_meet_sphere(struct rational *rational, struct vec3 origin, struct vec3 dir,
                          struct vec3 center, float radius, struct rational_chord *out);

/* `query` may be NULL. */
void rational_trace(struct rational *rational, const struct gpu_ray *ray,
                    const struct rational_query *query, struct rational_hit *hit);

/* Counts over all traced rays: primitives that were tested, and those that the filter left to
   integers. */
struct rational_work {
    uint64_t primitives, exact;
};
struct rational_work rational_work(const struct rational *rational);

#endif

/* A traversal in double of every record that a ray may hit: boxes are widened, so that rounding
   loses nothing. For answers that are surer than those of floats (oracle.c, rational.c). */
#ifndef ORACLE_CONSERVATIVE_H
#define ORACLE_CONSERVATIVE_H

#include "accel/accel.h"

/* A ray in the space of a tree. Boxes are widened by `growth` times the largest coordinate of their
   corners relative to the ray's origin, plus `margin`. */
struct conservative_ray {
    double origin[3], dir[3];
    double t_min, t_max;
    double growth, margin;
};

struct conservative_walk {
    const struct accel *accel;
    bool brute;                  /* visits every record of every instance, without boxes */
    bool done;                   /* set by `visit` to end the walk */
    double limit;                /* t behind which nothing matters; `visit` may lower it */
    struct conservative_ray ray; /* in the space of the current tree */
    /* Transforms walk->ray from world space to an instance's mesh; false: the ray hits nothing of
       it. Not called where there is only one tree, in world space. */
    bool (*enter)(struct conservative_walk *walk, uint32_t instance);
    /* Called for each record. Where the tree has split triangles, the records of one come several
       times. */
    void (*visit)(struct conservative_walk *walk, uint32_t record, uint32_t instance);
};

/* Runs the walk to its end, or until `done`. `walk->ray` is the ray in world space. Trees that are
   too deep for the stack, and scenes without trees, are walked as with `brute`. */
void conservative_walk_run(struct conservative_walk *walk);

/* The t at which walk->ray enters the widened box; INFINITY: not within [t_min, t_max] and the
   limit. Both ends are relaxed by a relative 2^-18 and a denormal, which is more than rounding to
   float. */
double conservative_entry(const struct conservative_walk *walk, const float lo[3],
                          const float hi[3]);

#endif

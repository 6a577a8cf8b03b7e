/* A walk in double over every record that a ray may meet: boxes are grown, so that roundings lose
   nothing. For answers that are surer than floats (oracle.c, rational.c). */
#ifndef ORACLE_CONSERVATIVE_H
#define ORACLE_CONSERVATIVE_H

#include "accel/accel.h"

/* A ray in the space of a tree. Boxes grow by `growth` times the largest coordinate of their
   corners relative to the ray's origin, and by `margin`. */
struct conservative_ray {
    double origin[3], dir[3];
    double t_min, t_max;
    double growth, margin;
};

struct conservative_walk {
    const struct accel *accel;
    bool brute;                  /* every record of every instance, no boxes */
    bool done;                   /* set by visit: nothing more is wanted */
    double limit;                /* what lies behind it does not matter; visit may lower it */
    struct conservative_ray ray; /* of the tree in hand */
    /* Sets walk->ray, which is the world's, to what it is in an instance's mesh; false: the ray
       meets nothing of it. Not called where rays meet the only tree as they are. */
    bool (*enter)(struct conservative_walk *walk, uint32_t instance);
    /* Records of trees that split triangles come more than once. */
    void (*visit)(struct conservative_walk *walk, uint32_t record, uint32_t instance);
};

/* Runs the walk to its end, or until `done`. `walk->ray` is the ray in the world. Trees too deep
   for the stack, and scenes without trees, are walked as `brute`. */
void conservative_walk_run(struct conservative_walk *walk);

/* The t at which walk->ray enters the grown box; INFINITY: not within [t_min, t_max] and the limit.
   Both ends are relaxed by 2^-18 (relative) and a denormal, more than rounding to float. */
double conservative_entry(const struct conservative_walk *walk, const float lo[3],
                          const float hi[3]);

#endif

/* The order of the hits of a ray, which decides between those that are equally near. */
#ifndef ACCEL_HIT_ORDER_H
#define ACCEL_HIT_ORDER_H

#include <stdbool.h>
#include <stdint.h>

/* Hits are ordered by these fields, the first one first. t is the ray's parameter, in lengths of
   its direction. */
struct hit_place {
    double t;
    uint32_t instance, primitive;
};

/* Whether hit `a` comes before hit `b`. With equal t, the smaller instance comes first, then the
   smaller primitive. So a ray's hit depends neither on the tree nor on the order of its traversal,
   on the device or the CPU. False if both are the same place, or a t is NaN.
   shaders/bind/traverse.glsl has the same rule in is_nearer and is_behind. */
static inline bool hit_comes_before(struct hit_place a, struct hit_place b)
{
    return a.t < b.t || (a.t == b.t && (a.instance < b.instance ||
                                        (a.instance == b.instance && a.primitive < b.primitive)));
}

#endif

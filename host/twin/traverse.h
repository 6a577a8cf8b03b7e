/* Traversal on the CPU: the twin of the shaders, bit for bit. */
#ifndef TWIN_TRAVERSE_H
#define TWIN_TRAVERSE_H

#include "accel/accel.h"

/* The hit that traverse_ray looks for; zeroed: the closest one, at NUMERICS_WATERTIGHT. */
struct traverse_params {
    uint32_t order;    /* ORDER_* */
    uint32_t numerics; /* NUMERICS_* */
    bool any;   /* any hit will do; then only whether `primitive` is HIT_NONE has a meaning */
    bool brute; /* no tree: every record of every instance */
    /* The hit where the ray starts, of which only the ids are read; NULL: none. Its primitive is
       not hit again, except a sphere at its far end, where the ray goes into it. */
    const struct gpu_hit *own;
    /* A hit of the same ray: the next one in the order of (t, instance, primitive) is wanted, and
       `own` is not read. It may be the hit that is written. NULL: the first one. */
    const struct gpu_hit *behind;
};

/* The twin of shaders/bind/traverse.glsl: the same operations in the same order, so the same bits
   and the same counters as a device with IEEE arithmetic. `params` may be NULL. Finds hits with
   t_min <= t <= t_max; equal t goes to the smaller instance, then primitive. The ray's counters are
   added to *cost (stack and depth: the maximum), which may be NULL; STATUS_* bits are or-ed into
   *status. */
void traverse_ray(const struct accel *accel, const struct traverse_params *params,
                  const struct gpu_ray *ray, struct gpu_hit *hit, struct gpu_cost *cost,
                  uint32_t *status);

#endif

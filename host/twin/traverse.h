/* Traversal on the CPU: the twin of the shaders, bit for bit. */
#ifndef TWIN_TRAVERSE_H
#define TWIN_TRAVERSE_H

#include "accel/accel.h"

struct traverse_params {
    uint32_t order;    /* ORDER_* */
    uint32_t numerics; /* NUMERICS_* */
    bool any;   /* any hit will do; then only whether `primitive` is HIT_NONE has a meaning */
    bool brute; /* no tree: every record of every instance */
    uint32_t skip_instance, skip_primitive; /* the primitive that is not hit; HIT_NONE: none */
};

/* The twin of shaders/bind/traverse.glsl: the same operations in the same order, so the same bits
   and the same counters as a device with IEEE arithmetic. Finds hits with t_min <= t <= t_max;
   equal t goes to the smaller instance, then primitive. The ray's counters are added to *cost
   (stack and depth: the maximum), which may be NULL; STATUS_* bits are or-ed into *status. */
void traverse_ray(const struct accel *accel, const struct traverse_params *params,
                  const struct gpu_ray *ray, struct gpu_hit *hit, struct gpu_cost *cost,
                  uint32_t *status);
/* The function above at NUMERICS_WATERTIGHT. */
void traverse_float(const struct accel *accel, uint32_t order, const struct gpu_ray *ray, bool any,
                    uint32_t skip_instance, uint32_t skip_primitive, struct gpu_hit *hit,
                    struct gpu_cost *cost, uint32_t *status);
/* Finds the hits of a ray one after the other, in the order of (t, instance, primitive): the first
   one where `before` is NULL, else the one behind *before, a hit of the same ray. `hit` may be
   `before`. The primitive that params says is not hit counts for the first hit only. */
void traverse_next(const struct accel *accel, const struct traverse_params *params,
                   const struct gpu_ray *ray, const struct gpu_hit *before, struct gpu_hit *hit,
                   uint32_t *status);
/* The function above at NUMERICS_WATERTIGHT. */
void traverse_next_float(const struct accel *accel, const struct gpu_ray *ray,
                         const struct gpu_hit *before, struct gpu_hit *hit, uint32_t *status);
/* The hit of traverse_float without any tree, by testing every primitive of every instance. */
void traverse_brute_float(const struct accel *accel, const struct gpu_ray *ray,
                          struct gpu_hit *hit);

#endif

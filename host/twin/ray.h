/* Rays in the form that the float mirror and the shaders use. */
#ifndef TWIN_RAY_H
#define TWIN_RAY_H

#include <stdbool.h>

#include "abi/bvh.h"
#include "base/vec.h"

/* Whether a ray is finite and has a direction. All others hit nothing. */
static inline bool accel_ray_is_usable(const struct gpu_ray *ray)
{
    struct vec3 o = vec3_load(ray->origin), d = vec3_load(ray->dir);
    struct vec3 bounded = vec3_add(vec3_sub(o, o), vec3_sub(d, d)); /* 0, or NaN */
    return bounded.x + bounded.y + bounded.z == 0.0f && (d.x != 0.0f || d.y != 0.0f || d.z != 0.0f);
}

static inline struct vec3 accel_rotate_rows(const float *r0, const float *r1, const float *r2,
                                            struct vec3 p)
{
    return vec3_make((r0[0] * p.x + r0[1] * p.y) + r0[2] * p.z,
                     (r1[0] * p.x + r1[1] * p.y) + r1[2] * p.z,
                     (r2[0] * p.x + r2[1] * p.y) + r2[2] * p.z);
}

/* The ray in an instance's object space, in floats. It has the roundings of the float mirror and
   the shaders, which are part of the ray: every answer, also an exact one, is about this ray. */
static inline struct gpu_ray accel_local_ray(const struct gpu_instance *instance,
                                             const struct gpu_ray *ray)
{
    const float *r0 = instance->inverse0, *r1 = instance->inverse1, *r2 = instance->inverse2;
    struct vec3 origin = vec3_make(instance->origin_x, instance->origin_y, instance->origin_z);
    struct vec3 relative = vec3_sub(vec3_load(ray->origin), origin);
    struct gpu_ray local = {.t_min = ray->t_min, .t_max = ray->t_max};
    vec3_store(local.origin, accel_rotate_rows(r0, r1, r2, relative));
    vec3_store(local.dir, accel_rotate_rows(r0, r1, r2, vec3_load(ray->dir)));
    return local;
}

#endif

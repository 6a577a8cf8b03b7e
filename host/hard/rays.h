/* Rays that make ray tracers fail. */
#ifndef HARD_RAYS_H
#define HARD_RAYS_H

#include "hard/hard.h"

const char *hard_rays_name(enum hard_rays rays);

/* A ray and the primitive that it starts on; HIT_NONE: on none. */
struct hard_ray {
    struct gpu_ray ray;
    uint32_t instance, primitive;
};

/* Makes ray `index` of the set `seed`. `rays` must suit the mesh, and the scene must have
   triangles. */
struct hard_ray hard_ray_make(const struct hard_scene *hard, enum hard_rays rays, uint64_t seed,
                              uint64_t index);

#endif

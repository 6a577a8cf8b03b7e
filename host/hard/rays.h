/* Rays at which ray tracers fail. */
#ifndef HARD_RAYS_H
#define HARD_RAYS_H

#include "hard/hard.h"

const char *hard_rays_name(enum hard_rays rays);

/* A ray and the primitive that it starts on; HIT_NONE: on none. */
struct hard_ray {
    struct gpu_ray ray;
    uint32_t instance, primitive;
};

/* Ray `index` of the set `seed`. `rays` is one that suits the mesh. The scene has triangles. */
struct hard_ray hard_ray_make(const struct hard_scene *hard, enum hard_rays rays, uint64_t seed,
                              uint64_t index);

#endif

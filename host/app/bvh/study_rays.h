/* Rays that builders are compared by. */
#ifndef APP_BVH_STUDY_RAYS_H
#define APP_BVH_STUDY_RAYS_H

#include "app/bvh/study.h"

/* Rays of the scene's first camera, one a pixel: line by line, or in tiles of 8x8, which `width`
   and `height` are then multiples of. `rays->rays` is the caller's to free. */
whit_result study_camera_rays(const whit_scene *scene, uint32_t width, uint32_t height, bool tiles,
                              struct study_rays *rays);
/* Rays from and to the hit of `ray`, whose intervals of t keep clear of the surface. The bounce ray
   leaves it in a random direction, cosine-weighted, the same for the same `index`; the light ray
   comes from a point light, with t 1 at the hit. `size`: study_scene_size. */
whit_ray study_bounce_ray(const whit_ray *ray, const whit_hit *hit, uint64_t index, double size);
whit_ray study_light_ray(const double light[3], const whit_ray *ray, const whit_hit *hit);
/* Steele, Lea and Flood 2014: splitmix64 of `index`, in [0, 1). */
double study_random(uint64_t index);
/* The diagonal of its bounds; 1 where they have none. */
double study_scene_size(const whit_scene *scene);

/* Rays of the scene's first camera, as many as come near ray_count. */
whit_result study_primary_rays(struct study *study);
/* From the hits of those: towards the lights in turns, and off at random by the cosine. None when
   nothing was hit. */
whit_result study_secondary_rays(struct study *study, const whit_hit *hits);

#endif

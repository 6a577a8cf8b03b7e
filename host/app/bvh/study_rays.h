/* The rays by which builders are compared. */
#ifndef APP_BVH_STUDY_RAYS_H
#define APP_BVH_STUDY_RAYS_H

#include "app/bvh/study.h"

/* Rays of the scene's first camera, one a pixel: line by line, or in tiles of 8x8, which `width`
   and `height` are then multiples of. `rays->rays` is the caller's to free. */
whit_result study_camera_rays(const whit_scene *scene, uint32_t width, uint32_t height, bool tiles,
                              struct study_rays *rays);
/* Rays that start or end at the hit of `ray`; their intervals of t exclude its surface. The bounce
   ray leaves it in a random direction, cosine-weighted, the same for the same `index`; the light
   ray comes from a point light, with t 1 at the hit. `size`: study_scene_size. */
whit_ray study_bounce_ray(const whit_ray *ray, const whit_hit *hit, uint64_t index, double size);
whit_ray study_light_ray(const double light[3], const whit_ray *ray, const whit_hit *hit);
/* Steele, Lea and Flood 2014: splitmix64 of `index`, in [0, 1). */
double study_random(uint64_t index);
/* The diagonal of the scene's bounds; 1 where it is empty or a point. */
double study_scene_size(const whit_scene *scene);

/* Makes rays of the scene's first camera, about as many as ray_count. */
whit_result study_primary_rays(struct study *study);
/* Makes rays from the hits of the primary rays: shadow rays to each light in turn, and diffuse rays
   in random cosine-weighted directions. None where nothing was hit. */
whit_result study_secondary_rays(struct study *study, const whit_hit *hits);

#endif

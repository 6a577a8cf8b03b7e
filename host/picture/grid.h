/* A grid on the ground, as a drawing over a picture. */
#ifndef PICTURE_GRID_H
#define PICTURE_GRID_H

#include "abi/bvh.h"
#include "scene/scene.h"

/* For the camera rays of a picture, row by row: how much of each pixel lines cover, 0 to 1, and
   how far such a ray goes to the ground, as its t_max; below 0 for the others. The ground is
   horizontal, just below all of the scene, and lines fade where they are too fine to be seen and
   far from it. */
void grid_cover(const struct scene_pose *pose, uint32_t width, uint32_t height,
                struct gpu_ray *rays, float *cover);

#endif

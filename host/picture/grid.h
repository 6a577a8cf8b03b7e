/* A grid on the ground, as a drawing over a picture. */
#ifndef PICTURE_GRID_H
#define PICTURE_GRID_H

#include "abi/bvh.h"
#include "scene/scene.h"

/* Goes over the camera rays of a picture, row by row. `cover`: how much of the pixel is covered by
   lines of the grid, 0 to 1. The ray's t_max becomes its way to the ground, and is below 0 where no
   line is seen. The ground is horizontal, just below all of the scene, and lines fade where they
   are too fine to be seen and far from it. */
void grid_cover(const struct scene_pose *pose, uint32_t width, uint32_t height,
                struct gpu_ray *rays, float *cover);

#endif

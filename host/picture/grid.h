/* A grid on the ground, drawn over a picture. */
#ifndef PICTURE_GRID_H
#define PICTURE_GRID_H

#include "abi/bvh.h"
#include "scene/scene.h"

/* Finds the grid for all pixels of a picture from their camera rays, row by row. `cover`: the share
   of the pixel that lines of the grid cover, 0 to 1. The ray's t_max is set to the t of the ground,
   or below 0 where no line is seen. The ground is horizontal, just below the whole scene; lines
   fade where they are too fine to be seen, and far from the scene. */
void grid_cover(const struct scene_pose *pose, uint32_t width, uint32_t height,
                struct gpu_ray *rays, float *cover);

#endif

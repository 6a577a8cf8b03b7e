/* The environment map as shaders and reference read it. */
#ifndef PICTURE_ENVIRONMENT_H
#define PICTURE_ENVIRONMENT_H

#include "scene/scene.h"

/* Resamples the map to an octahedral square of *size texels a side, RGBA; free() it. NULL for a
   gradient. False when memory runs out. */
bool environment_resample(const struct scene_environment *environment, uint32_t *size,
                          float **texels);

#endif

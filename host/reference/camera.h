/* Camera rays. */
#ifndef REFERENCE_CAMERA_H
#define REFERENCE_CAMERA_H

#include "reference/inside.h"

struct ray camera_first_ray(const struct reference *reference, uint32_t x, uint32_t y,
                            uint32_t sample);
/* The area that a sample stands for, perpendicular to its ray, at distance `way` from the eye along
   the path of rays. It chooses the mipmap level. */
double camera_texel_area(const struct reference *reference, uint32_t x, uint32_t y, uint32_t sample,
                         double way);

#endif

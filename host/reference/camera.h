/* Camera rays. */
#ifndef REFERENCE_CAMERA_H
#define REFERENCE_CAMERA_H

#include "reference/inside.h"

struct ray camera_first_ray(const struct reference *reference, uint32_t x, uint32_t y,
                            uint32_t sample);
/* The area of a texel that a sample of the pixel asks for, across its camera ray `way` from the
   eye. */
double camera_texel_area(const struct reference *reference, uint32_t x, uint32_t y, uint32_t sample,
                         double way);

#endif

/* The curve of sRGB (IEC 61966-2-1), between 0 and 1. */
#ifndef BASE_COLOR_H
#define BASE_COLOR_H

#include <math.h>

static inline double srgb_from_linear(double linear)
{
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1.0 / 2.4) - 0.055;
}

static inline double linear_from_srgb(double srgb)
{
    return srgb <= 0.04045 ? srgb / 12.92 : pow((srgb + 0.055) / 1.055, 2.4);
}

#endif

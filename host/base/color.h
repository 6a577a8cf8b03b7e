/* The transfer curve of sRGB (IEC 61966-2-1) for values in 0..1, the luminance of its primaries,
   and a curve that keeps highlights below 1. */
#ifndef BASE_COLOR_H
#define BASE_COLOR_H

#include <math.h>
#include <stdbool.h>

#include "base/same.h"

static inline double srgb_from_linear(double linear)
{
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * same_pow(linear, 1.0 / 2.4) - 0.055;
}

static inline double linear_from_srgb(double srgb)
{
    return srgb <= 0.04045 ? srgb / 12.92 : same_pow((srgb + 0.055) / 1.055, 2.4);
}

/* Whether no channel is above 0. */
static inline bool color_is_black(const float rgb[3])
{
    return !(rgb[0] > 0.0f || rgb[1] > 0.0f || rgb[2] > 0.0f);
}

static inline double color_luminance(const float rgb[3])
{
    return 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
}

/* Leaves values up to 0.6 alone; from there on a hyperbola with the same slope runs towards 1. */
static inline float color_shoulder(float linear)
{
    const float from = 0.6f, rest = 1.0f - from;
    float over = (linear - from) / rest;
    return !(linear > from) || isinf(linear) ? linear : from + rest * over / (1.0f + over);
}

#endif

/* Heat maps: numbers as colours. */
#ifndef IMAGE_HEAT_H
#define IMAGE_HEAT_H

#include "image/image.h"
#include "whit/whit_image.h"

/* Gives the sRGB codes of viridis for `share`, clamped to 0 (dark) .. 1 (bright). */
void heat_color(double share, uint8_t codes[3]);

/* The same for a signed `share`, clamped to -1 (dark blue) .. 1 (dark brown): 0 is nearly white,
   and both sides get darker away from it. Safe for red-green colour blindness. */
void heat_signed_color(double share, uint8_t codes[3]);

/* The scale of a heat map: the 99.5th percentile of the finite values, rounded up to a round
   number; if that is 0, the largest value, rounded up too; if all are 0, 1. */
double image_heat_scale(const struct image *values);

/* Makes a heat map of `values`, one channel, with a legend below, in linear RGB whose sRGB codes
   are exactly those of heat_color. It is at least as wide as a short legend. Non-finite values
   stay. With is_signed, `values` may have three or four channels: the one of the first three that
   is farthest from 0 counts, and the default scale is that of absolute values. WHIT_ERROR_USAGE for
   other pictures, and for scales below 0. */
WHIT_CHECK whit_result image_heat(const struct image *values, const whit_heat_params *params,
                                  struct image *out);

#endif

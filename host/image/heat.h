/* Numbers as colours. */
#ifndef IMAGE_HEAT_H
#define IMAGE_HEAT_H

#include "image/image.h"
#include "whit/whit_image.h"

/* Viridis: sRGB codes of `share`, 0 (dark) to 1 (bright), which is clamped. */
void heat_color(double share, uint8_t codes[3]);

/* `share` from -1 (dark blue) over 0 (nearly white) to 1 (dark brown), clamped: the darker, the
   farther from 0, on both sides. Who sees no red or green can tell the sides apart. */
void heat_signed_color(double share, uint8_t codes[3]);

/* The 99.5th percentile of the finite values, rounded up to a number that reads well; when it is 0,
   the same of the largest one; 1 when that is 0 too. */
double image_heat_scale(const struct image *values);

/* `values` of one channel as linear RGB whose sRGB codes are exactly those of heat_color, with a
   legend below; at least as wide as a short legend. Not finite stays so. With is_signed also of
   three or four channels: of the first three the one farthest from 0, and the scale by itself is
   that of the distances. WHIT_ERROR_USAGE for other pictures and scales below 0. */
WHIT_CHECK whit_result image_heat(const struct image *values, const whit_heat_params *params,
                                  struct image *out);

#endif

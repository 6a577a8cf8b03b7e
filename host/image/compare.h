/* Differences of two pictures. */
#ifndef IMAGE_COMPARE_H
#define IMAGE_COMPARE_H

#include "image/image.h"
#include "whit/whit_compare.h"

/* Pixel `index` of floats as RGBA, where grey fills three channels and alpha is 1 where there is
   none, as it is displayed, still linear and not clamped. */
void image_displayed_pixel(const struct image *image, size_t index, float rgba[4]);

/* Added to a^2 in whit_difference.relative_mse. */
#define IMAGE_RELATIVE_FLOOR 0.01

/* Floats may differ in their channels: they are compared as RGBA, not as displayed, alpha only
   for differing_pixels and over_1_255. WHIT_ERROR_INPUT when sizes or kinds differ. Pixels that are
   not finite in one of the two count as differing and over_1_255 unless their bits are the same;
   they are left out of all means and of `largest`, which of integers is 1 where they differ. FLIP
   is left at 0. */
WHIT_CHECK whit_result image_compare(const whit_log *log, const struct image *a,
                                     const struct image *b, whit_difference *out);
/* b - a of each channel, RGB, linear; NAN in all three where either pixel is not finite.
 * WHIT_ERROR_INPUT as above, and for integers. */
WHIT_CHECK whit_result image_subtract(const whit_log *log, const struct image *a,
                                      const struct image *b, struct image *out);

#endif

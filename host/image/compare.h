/* Differences between two pictures. */
#ifndef IMAGE_COMPARE_H
#define IMAGE_COMPARE_H

#include "image/image.h"
#include "whit/whit_compare.h"

/* Pixel `index` of a picture of floats as it is displayed, but linear and not clamped. Grey fills
   three channels; alpha is 1 where there is none. */
void image_displayed_pixel(const struct image *image, size_t index, float rgba[4]);

/* Added to a^2 in whit_difference.relative_mse. */
#define IMAGE_RELATIVE_FLOOR 0.01

/* Compares floats with floats, as RGBA whatever channels they have, and without display_scale; or
   integers with integers. Alpha counts only for differing_pixels and over_1_255. `largest` is 1 for
   integers that differ. Pixels that are not finite in either picture count as differing and
   over_1_255 unless their bits are equal; they are left out of means and `largest`. FLIP is left at
   0. WHIT_ERROR_INPUT when sizes or kinds differ. */
WHIT_CHECK whit_result image_compare(const whit_log *log, const struct image *a,
                                     const struct image *b, whit_difference *out);
/* b - a as linear RGB; NAN in all channels where either pixel is not finite. WHIT_ERROR_INPUT as
   above, and for integers. */
WHIT_CHECK whit_result image_subtract(const whit_log *log, const struct image *a,
                                      const struct image *b, struct image *out);

#endif

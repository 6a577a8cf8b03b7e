/* Differences of two pictures. */
#ifndef IMAGE_COMPARE_H
#define IMAGE_COMPARE_H

#include "image/image.h"

/* Pixel `index` of floats as RGBA, where grey fills three channels and alpha is 1 where there is
   none, as it is displayed, still linear and not clamped. */
void image_displayed_pixel(const struct image *image, size_t index, float rgba[4]);

/* How `b` differs from `a`, the reference. */
struct image_difference {
    uint64_t pixel_count, differing_pixels; /* any channel differs in a bit */
    uint64_t over_1_255;                    /* pixels with a channel over 1/255 (sRGB) apart */
    uint64_t nonfinite_a, nonfinite_b;
    uint64_t nonfinite_differing; /* of differing_pixels those not finite in one or both */
    double rmse, largest;         /* linear, over RGB; largest also of integers (1: they differ) */
    double relative_mse; /* mean over RGB of (b - a)^2 / (a^2 + IMAGE_RELATIVE_FLOOR), linear */
    double mean[3];      /* of b - a, linear: above 0 where b is brighter */
};
#define IMAGE_RELATIVE_FLOOR 0.01

/* Floats may differ in their channels: they are compared as RGBA, not as displayed, alpha only
   for differing_pixels and over_1_255. WHIT_ERROR_INPUT when sizes or kinds differ. Pixels that are
   not finite in one of the two count as differing and over_1_255 unless their bits are the same;
   they are left out of all means and of largest. */
WHIT_CHECK whit_result image_compare(const whit_log *log, const struct image *a,
                                     const struct image *b, struct image_difference *out);
/* b - a of each channel, RGB, linear; NAN in all three where either pixel is not finite.
 * WHIT_ERROR_INPUT as above, and for integers. */
WHIT_CHECK whit_result image_subtract(const whit_log *log, const struct image *a,
                                      const struct image *b, struct image *out);

#endif

/* Part of whit.h: how two images differ. */
#ifndef WHIT_COMPARE_H
#define WHIT_COMPARE_H

#include "whit_types.h"

WHIT_C_BEGIN

/* The difference of `b` from `a`, the reference; over RGB, linear, unless said otherwise. Grey
   counts as three equal channels, a missing alpha as 1. For images of hit identities only
   pixel_count and differing_pixels have a meaning. */
typedef struct whit_difference {
    uint64_t pixel_count;
    uint64_t differing_pixels; /* pixels in which any bit differs, alpha included */
    uint64_t over_1_255;       /* pixels with a channel, alpha included, more than 1/255 apart as
                                  displayed (8-bit sRGB) */
    uint64_t nonfinite_a, nonfinite_b; /* pixels that are not finite; rmse, relative_mse, largest
                                          and mean leave them out */
    uint64_t nonfinite_differing;      /* those of differing_pixels that are not finite in one image
                                          or both */
    double rmse;                       /* root of the mean squared error */
    double relative_mse;               /* mean of (b - a)^2 / (a^2 + 0.01) */
    double largest;                    /* largest difference of any channel */
    double mean[3];                    /* of b - a: above 0 where b is brighter */
    /* LDR-FLIP (Andersson et al. 2020): from 0 (looks the same) to 1, computed on the pictures as
       displayed, clamped to [0, 1], with non-finite pixels as magenta. */
    double flip_mean, flip_largest;
} whit_difference;
/* A screen 0.7 m wide with 3840 pixels across, seen from 0.7 m. */
#define WHIT_FLIP_PIXELS_PER_DEGREE 67.02064327658226
typedef struct whit_compare_params {
    bool no_flip;             /* skips FLIP, which takes most of the time; flip_mean and
                                 flip_largest are 0 then */
    double pixels_per_degree; /* as the viewer of the pictures sees them, 1 to 1000; 0:
                                 WHIT_FLIP_PIXELS_PER_DEGREE */
} whit_compare_params;
/* WHIT_ERROR_INPUT when sizes or kinds differ, WHIT_ERROR_USAGE for params out of range.
   `flip_map`: may be NULL; gets an image of one channel with the FLIP of each pixel (NULL where
   FLIP is skipped). */
WHIT_CHECK whit_result whit_image_compare(const whit_image *a, const whit_image *b,
                                          const whit_compare_params *params, const whit_log *log,
                                          whit_difference *out, whit_image **flip_map);
/* b - a, linear RGB, for whit_image_heat with is_signed, or to be saved as it is: NaN where either
   image is not finite. WHIT_ERROR_INPUT when sizes or kinds differ, WHIT_ERROR_USAGE for images of
   hit identities. */
WHIT_CHECK whit_result whit_image_subtract(const whit_image *a, const whit_image *b,
                                           const whit_log *log, whit_image **out);

WHIT_C_END

#endif

/* Part of whit.h: how two images differ. */
#ifndef WHIT_COMPARE_H
#define WHIT_COMPARE_H

#include "whit_types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* How `b` differs from `a`, the reference; over RGB, linear, unless said otherwise. Grey counts as
   three equal channels, a missing alpha as 1. Of hit identities only pixel_count and
   differing_pixels mean something. */
typedef struct whit_difference {
    uint64_t pixel_count;
    uint64_t differing_pixels; /* by any bit, alpha included */
    uint64_t over_1_255;       /* a channel is more than 1/255 apart as displayed (8-bit sRGB) */
    uint64_t nonfinite_a, nonfinite_b; /* pixels; they are left out of what follows, up to flip */
    uint64_t nonfinite_differing;      /* of differing_pixels those not finite in one or both */
    double rmse;                       /* root of the mean squared error */
    double relative_mse;               /* mean of (b - a)^2 / (a^2 + 0.01) */
    double largest;                    /* of any channel */
    double mean[3];                    /* of b - a: above 0 where b is brighter */
    /* LDR-FLIP (Andersson et al. 2020): 0, looks the same, to 1; of pictures as displayed, clamped
       to [0, 1], with what is not finite as magenta. */
    double flip_mean, flip_largest;
} whit_difference;
/* A screen of 0.7 m with 3840 pixels, seen from 0.7 m. */
#define WHIT_FLIP_PIXELS_PER_DEGREE 67.02064327658226
typedef struct whit_compare_params {
    bool no_flip;             /* leave FLIP out, which takes most of the time: both are 0 then */
    double pixels_per_degree; /* of who looks at the pictures, 1 to 1000;
                                 0: WHIT_FLIP_PIXELS_PER_DEGREE */
} whit_compare_params;
/* WHIT_ERROR_INPUT when sizes or kinds differ, WHIT_ERROR_USAGE for params out of range.
   `flip_map`: NULL, or gets FLIP of each pixel as one channel (NULL without FLIP). */
WHIT_CHECK whit_result whit_image_compare(const whit_image *a, const whit_image *b,
                                          const whit_compare_params *params, const whit_log *log,
                                          whit_difference *out, whit_image **flip_map);
/* b - a, linear RGB, for whit_image_heat with is_signed, or to be saved as it is: NAN where either
   is not finite. WHIT_ERROR_INPUT when sizes or kinds differ. */
WHIT_CHECK whit_result whit_image_subtract(const whit_image *a, const whit_image *b,
                                           const whit_log *log, whit_image **out);

#ifdef __cplusplus
}
#endif

#endif

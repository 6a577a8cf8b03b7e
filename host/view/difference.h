/* Measures the difference of two pictures of the same size, pixel by pixel. */
#ifndef VIEW_DIFFERENCE_H
#define VIEW_DIFFERENCE_H

#include <stdbool.h>
#include <stdint.h>

#include "whit/whit_image.h"

/* One of two pictures that are compared: `color` has `channels` linear floats a pixel (1, or 4 with
   an alpha that does not count), `ids` two words of hit identity a pixel. Either may be NULL. */
struct difference_side {
    const float *color;
    const uint32_t *ids;
};

struct difference {
    uint64_t pixels;
    uint64_t other_ids;    /* pixels that hit something else; 0 without identities */
    uint64_t other_colors; /* pixels with a channel that differs */
    double largest, mean;  /* of |a - b| over channels; NaN if one is NaN */
};
/* FLIP of both pictures as displayed (whit_compare.h): the mean over all pixels, and the largest
   (may be NULL). False: not known, as they have no colours, or memory ran out. */
bool difference_flip(const whit_image *a, const whit_image *b, double *mean, double *largest);
void difference_measure(const struct difference_side *a, const struct difference_side *b,
                        uint32_t channels, uint64_t pixels, struct difference *out);

#endif

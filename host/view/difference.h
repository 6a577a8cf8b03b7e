/* Measures the difference of two pictures of the same size, pixel by pixel. */
#ifndef VIEW_DIFFERENCE_H
#define VIEW_DIFFERENCE_H

#include <stdbool.h>
#include <stdint.h>

#include "whit/whit_image.h"

struct difference {
    uint64_t pixels;
    uint64_t other_ids;    /* pixels that hit something else; 0 without identities */
    uint64_t other_colors; /* pixels with a channel that differs */
    double largest, mean;  /* of |a - b| over channels; NaN if one is NaN */
};
/* FLIP of both pictures as displayed (whit_compare.h): the mean over all pixels, and the largest
   (may be NULL). False: not known, as they have no colours, or memory ran out. */
bool difference_flip(const whit_image *a, const whit_image *b, double *mean, double *largest);
/* Compares the colours of two pictures of the same size, which are floats, of which alpha does not
   count, and their ids, two words of hit identity a pixel. Of each picture either may be NULL. */
void difference_measure(const whit_image *color_a, const whit_image *color_b,
                        const whit_image *ids_a, const whit_image *ids_b, struct difference *out);

#endif

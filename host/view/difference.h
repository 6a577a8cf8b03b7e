/* Measures the difference of two pictures of the same size, pixel by pixel. */
#ifndef VIEW_DIFFERENCE_H
#define VIEW_DIFFERENCE_H

#include <stdbool.h>
#include <stdint.h>

#include "whit/whit_image.h"

/* One of two pictures of the same size that are compared. `color` has floats, of which alpha does
   not count; `ids` two words of hit identity a pixel. Either may be NULL. */
struct difference_side {
    const whit_image *color, *ids;
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
                        struct difference *out);

#endif

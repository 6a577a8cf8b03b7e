/* What differs between two pictures of one size, pixel by pixel. */
#ifndef VIEW_DIFFERENCE_H
#define VIEW_DIFFERENCE_H

#include <stdbool.h>
#include <stdint.h>

#include "whit/whit_image.h"

/* One of two pictures that are compared: `channels` linear floats a pixel (1, or 4 of which alpha
   does not count) and two words of hit identity a pixel. Either may be NULL. */
struct difference_side {
    const float *color;
    const uint32_t *ids;
};

struct difference {
    uint64_t pixels;
    uint64_t other_ids;    /* pixels that hit something else; 0 without identities */
    uint64_t other_colors; /* pixels of which a channel is another number */
    double largest, mean;  /* of |a - b| of a channel; NAN where one is not a number */
};
/* How different they look (whit_compare.h), both as they are displayed: the mean over all pixels,
   and the largest (may be NULL). False where that cannot be said: no colours, or no memory. */
bool difference_flip(const whit_image *a, const whit_image *b, double *mean, double *largest);
void difference_measure(const struct difference_side *a, const struct difference_side *b,
                        uint32_t channels, uint64_t pixels, struct difference *out);

#endif

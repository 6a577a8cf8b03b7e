/* How two pictures of one size differ, in words, and at which pixel most. */
#ifndef APP_CHECK_DRAWING_DIFFERENCE_H
#define APP_CHECK_DRAWING_DIFFERENCE_H

#include "app/check/draw.h"

struct drawing_difference {
    bool same_size;
    uint64_t others; /* pixels whose colour or hit differs in any bit */
    uint64_t hits;   /* those of them with another hit */
    uint32_t x, y;   /* pixel with the largest colour difference, among those with another hit if
                        there are any */
};

void drawing_difference_find(const struct drawing *before, const struct drawing *after,
                             struct drawing_difference *out);
/* "214 pixels other, 96 hit something else" */
void drawing_difference_write(const struct drawing_difference *difference, FILE *to);
/* "; pixel 212,87: was ball 5532 at 4.1021, is floor 0 at 5.87": the two hits of the pixel, probed
   by both renderers; nothing where one cannot. Names are as the files have them. */
void drawing_difference_write_pixel(const struct drawing_difference *difference,
                                    const struct drawing *before, const struct drawing *after,
                                    FILE *to);

#endif

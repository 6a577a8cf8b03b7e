/* How different two pictures look when they are shown in turns. */
#ifndef IMAGE_FLIP_H
#define IMAGE_FLIP_H

#include "image/image.h"

/* A screen of 0.7 m with 3840 pixels, seen from 0.7 m: 3840 pi / 180. */
#define FLIP_PIXELS_PER_DEGREE 67.02064327658226
enum { FLIP_PIXELS_PER_DEGREE_MAX = 1000 };

struct flip_summary {
    double mean, largest; /* over the map's pixels */
};

/* LDR-FLIP: Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astroem and Fairchild, "FLIP: A
   Difference Evaluator for Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2),
   2020, with its erratum (Y is normalised by 116). There is no HDR-FLIP: pictures are compared as a
   PNG shows them, clamped to [0, 1] and with magenta for non-finite pixels, but not rounded to 8
   bits. Alpha is ignored.

   *map has one channel, 0 (looks the same) to 1: green against blue gives 1, black against white
   0.9674. Swapping the pictures changes nothing. WHIT_ERROR_USAGE when sizes differ, for integers,
   and for `pixels_per_degree` (0: FLIP_PIXELS_PER_DEGREE) outside 1 to FLIP_PIXELS_PER_DEGREE_MAX.
   Needs about 52 bytes per pixel while it works. */
WHIT_CHECK whit_result image_flip(const struct image *a, const struct image *b,
                                  double pixels_per_degree, struct image *map,
                                  struct flip_summary *summary);

#endif

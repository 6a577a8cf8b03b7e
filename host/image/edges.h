/* Outlines of instances or primitives, drawn over a picture. */
#ifndef IMAGE_EDGES_H
#define IMAGE_EDGES_H

#include "image/image.h"

/* Blackens pixels of `color` whose right or lower neighbour hits another instance, or with
   `of_primitives` another primitive. `ids`: instance and primitive of each pixel, same size. */
void image_draw_edges(struct image *color, const struct image *ids, bool of_primitives);

#endif

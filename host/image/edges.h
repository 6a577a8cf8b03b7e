/* Edges of what is seen, drawn over a picture. */
#ifndef IMAGE_EDGES_H
#define IMAGE_EDGES_H

#include "image/image.h"

/* Makes pixels of `color` black beside whose right or lower neighbour something else is hit, by
   `ids` of the same size (instance, primitive): another instance, or with `of_primitives` another
   primitive too. */
void image_draw_edges(struct image *color, const struct image *ids, bool of_primitives);

#endif

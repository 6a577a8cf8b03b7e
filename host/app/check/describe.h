/* Makes the entry of a golden file from a picture that was drawn. */
#ifndef APP_CHECK_DESCRIBE_H
#define APP_CHECK_DESCRIBE_H

#include "app/check/draw.h"

/* Hashes of an image of floats (colours, costs) and of hit identities. All NaN count as one value,
   because their sign and bits depend on the device. */
uint64_t drawing_hash_floats(const whit_image *image);
uint64_t drawing_hash_ids(const whit_image *image);

/* The linear colour of a pixel; a single channel is repeated three times. */
void drawing_color_at(const struct drawing *drawing, size_t pixel, double rgb[3]);
/* Finds the mean colour of the pixels that are finite; `pick` below 0: the smallest of each
   channel, above 0: the largest. It is black where no pixel is finite. Returns the number of these
   pixels. */
size_t drawing_find_colors(const struct drawing *drawing, int pick, double rgb[3]);
/* The number of pixels whose camera ray hits something. */
size_t drawing_count_hits(const struct drawing *drawing);

/* Makes a golden with one case, named like `item`, from a drawing, with its parts.
   WHIT_ERROR_MEMORY, with a message. */
WHIT_CHECK whit_result drawing_describe(const struct drawing *drawing,
                                        const struct check_case *item, struct golden *found);

#endif

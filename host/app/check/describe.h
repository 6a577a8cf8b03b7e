/* Reads from a drawing what it shows, and makes the entry of a golden file of it. */
#ifndef APP_CHECK_DESCRIBE_H
#define APP_CHECK_DESCRIBE_H

#include "app/check/draw.h"

/* Hashes of an image of floats (colours, costs) and of hit identities. All NaN count as one value,
   because their sign and bits depend on the device. */
uint64_t drawing_hash_floats(const whit_image *image);
uint64_t drawing_hash_ids(const whit_image *image);

/* The linear colour of a pixel; a single channel is repeated three times. */
void drawing_color_at(const struct drawing *drawing, size_t pixel, double rgb[3]);
/* Finds one linear colour of all pixels that are finite; black where there are none. Returns the
   number of these pixels. */
size_t drawing_find_color(const struct drawing *drawing, enum color_of which, double rgb[3]);
/* The number of pixels whose camera ray hits something. */
size_t drawing_count_hits(const struct drawing *drawing);
/* The camera ray of a pixel's first sample, traced again, its hit in ray->device; a miss where a
   shader's camera() sends none. */
WHIT_CHECK whit_result drawing_probe(const struct drawing *drawing, uint32_t x, uint32_t y,
                                     whit_probe_ray *ray);

/* Makes a golden with one case, named like `item`, from a drawing, with its parts.
   WHIT_ERROR_MEMORY, with a message. */
WHIT_CHECK whit_result drawing_describe(const struct drawing *drawing,
                                        const struct check_case *item, struct golden *found);

#endif

/* Small pictures for people: thumbnails beside a golden, and pictures in a report. */
#ifndef APP_CHECK_PICTURES_H
#define APP_CHECK_PICTURES_H

#include <stddef.h>

#include "whit/whit.h"

enum { THUMBNAIL_BYTES_MAX = 4096, PICTURE_BYTES_MAX = 48 << 10 };

struct drawing;

/* A PNG in memory; zeroed: there is none. */
struct check_png {
    uint8_t *data;
    size_t size_bytes;
};

struct check_pictures {
    struct check_png thumbnail; /* at most THUMBNAIL_BYTES_MAX */
    struct check_png after;  /* the picture in its size, or divided by a whole number where it would
                                exceed PICTURE_BYTES_MAX */
    struct check_png before; /* the old picture; none where it was not kept */
    /* In the size of `before`: the difference as displayed, 8 times as bright, and FLIP. */
    struct check_png difference, flip;
    double flip_mean;
};

/* Encodes a drawn picture as `after` and `thumbnail`. WHIT_ERROR_MEMORY, with a message. */
WHIT_CHECK whit_result check_pictures_make(struct check_pictures *pictures,
                                           const struct drawing *drawing);
/* Adds the old picture as displayed, in the size of the drawing or that divided by a whole number;
   one of another size is left out. WHIT_ERROR_MEMORY, with a message. */
WHIT_CHECK whit_result check_pictures_compare(struct check_pictures *pictures,
                                              const struct drawing *drawing,
                                              const whit_image *before);
void check_pictures_finish(struct check_pictures *pictures);

#endif

/* Small pictures for people: thumbnails beside a golden, and what a report shows. */
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
    struct check_png after;  /* the picture in its size, or in whole parts of it where it would be
                                more than PICTURE_BYTES_MAX */
    struct check_png before; /* what it was; none where nobody has kept it */
    /* In the size of `before`: the difference as displayed, 8 times as bright, and FLIP. */
    struct check_png difference, flip;
    double flip_mean;
};

/* Encodes a picture that was drawn: `after` and `thumbnail`. WHIT_ERROR_MEMORY, said. */
WHIT_CHECK whit_result check_pictures_make(struct check_pictures *pictures,
                                           const struct drawing *drawing);
/* Adds what it was: a picture as it is displayed, in its size or in a whole part of it. One in
   another size is left out. WHIT_ERROR_MEMORY, said. */
WHIT_CHECK whit_result check_pictures_compare(struct check_pictures *pictures,
                                              const struct drawing *drawing,
                                              const whit_image *before);
void check_pictures_finish(struct check_pictures *pictures);

#endif

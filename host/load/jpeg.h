/* JPEG into pixels, by libjpeg. */
#ifndef LOAD_JPEG_H
#define LOAD_JPEG_H

#include "load/picture.h"

bool jpeg_is(const uint8_t *data, size_t size_bytes);

/* As picture_decode(). Pictures with missing or invalid data, which libjpeg would fill with grey,
   are refused. All CMYK pictures are taken to have inverted inks, as Adobe writes them. `reason` is
   valid until the next call in this thread. */
WHIT_CHECK whit_result jpeg_decode(const uint8_t *data, size_t size_bytes, uint64_t pixels_max,
                                   struct picture *out, const char **reason);

#endif

/* JPEG into pixels, by libjpeg. */
#ifndef LOAD_JPEG_H
#define LOAD_JPEG_H

#include "load/picture.h"

bool jpeg_is(const uint8_t *data, size_t size_bytes);

/* As picture_decode(). A picture that libjpeg would patch up, because data are missing or make no
   sense, is refused: what it puts there is grey. Every CMYK picture is taken as Adobe writes it,
   with inverted inks. `reason` holds until the next call of this thread. */
WHIT_CHECK whit_result jpeg_decode(const uint8_t *data, size_t size_bytes, struct picture *out,
                                   const char **reason);

#endif

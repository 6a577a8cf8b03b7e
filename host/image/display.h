/* Converts linear floats to the sRGB bytes of screens and PNG files. */
#ifndef IMAGE_DISPLAY_H
#define IMAGE_DISPLAY_H

#include "image/image.h"

/* Tables to convert linear to 8-bit sRGB, rounded to nearest. `first`: the code at the start of
   each of 4096 cells of [0, 1]; `from`: the smallest linear value of each code. */
enum { DISPLAY_CELLS = 4096 };
struct display_encoder {
    uint8_t first[DISPLAY_CELLS + 1];
    float from[257];
};
void display_encoder_init(struct display_encoder *encoder);
/* Converts rows by all threads: each pixel to 1, 3 or 4 bytes. Grey is repeated, alpha is 255 where
   there is none. Non-finite pixels become magenta. */
void display_encode(const struct display_encoder *encoder, const struct image *image,
                    uint32_t first_row, uint32_t row_count, uint8_t *to, uint32_t to_channels);

/* Converts a picture of floats to the RGBA pixels that its PNG has: width * height * 4 bytes. */
void display_bytes(const struct image *image, uint8_t *rgba);

#endif

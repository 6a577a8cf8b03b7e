/* Linear floats as the bytes that screens and PNG files take. */
#ifndef IMAGE_DISPLAY_H
#define IMAGE_DISPLAY_H

#include "image/image.h"

/* linear -> 8-bit sRGB, rounded to nearest: `first` gives for each of 4096 cells of [0, 1] the
   code at its start, `from` the smallest linear value of each code. */
enum { DISPLAY_CELLS = 4096 };
struct display_encoder {
    uint8_t first[DISPLAY_CELLS + 1];
    float from[257];
};
void display_encoder_init(struct display_encoder *encoder);
/* Pixel `index` to 1, 3 or 4 bytes; grey is repeated. Magenta where it is not finite. */
void display_encode(const struct display_encoder *encoder, const struct image *image, size_t index,
                    uint8_t *to, uint32_t to_channels);

/* The bytes of the PNG file of a picture of floats, as RGBA: width * height * 4 of them. */
void display_bytes(const struct image *image, uint8_t *rgba);

#endif

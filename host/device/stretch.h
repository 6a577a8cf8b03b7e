#ifndef DEVICE_STRETCH_H
#define DEVICE_STRETCH_H
#include <stdbool.h>
#include <stdint.h>

/* A picture of 4 bytes a pixel that is scaled to another size bilinearly: centres of pixels meet,
   and beyond the outermost centres the colour stays the same. Bytes are within 2 of 255 of the
   exact value, and the same on every machine, as only integers are used. */
struct stretch {
    const uint8_t *from;              /* from_width * from_height * 4, borrowed */
    uint32_t from_width, from_height; /* pixels, at least 1 */
    uint32_t width, height;           /* of the scaled picture */
    bool swaps;                       /* the first and the third byte change places */
};

/* Bytes of scratch memory that stretch_begin and stretch_row need. */
uint64_t stretch_scratch_bytes(const struct stretch *stretch);
/* Computes where the pixels of a row come from, once before the first stretch_row. `scratch` is
   aligned as for uint64_t, and is passed to stretch_row. */
void stretch_begin(const struct stretch *stretch, void *scratch);
/* Writes row y, width * 4 bytes. */
void stretch_row(const struct stretch *stretch, void *scratch, uint32_t y, uint32_t *row);

#endif

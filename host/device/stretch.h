#ifndef DEVICE_STRETCH_H
#define DEVICE_STRETCH_H
#include <stdbool.h>
#include <stdint.h>

/* A picture of 4 bytes a pixel that is scaled to another size bilinearly: centres of pixels meet,
   and beyond the outermost centres colours go on. Within 2 of the exact value, by integers alone:
   the same bytes everywhere. */
struct stretch {
    const uint8_t *from; /* from_width * from_height * 4, borrowed */
    uint32_t from_width, from_height, width, height;
    bool swaps; /* the first and the third byte change places */
};

/* Bytes of scratch memory for stretch_row. */
uint64_t stretch_scratch_bytes(const struct stretch *stretch);
/* Begins: `scratch` is aligned as for uint64_t. */
void stretch_begin(const struct stretch *stretch, void *scratch);
/* Writes row y, width * 4 bytes. */
void stretch_row(const struct stretch *stretch, void *scratch, uint32_t y, uint32_t *row);

#endif

/* The colours of heat maps, as whit_image_heat gives them. */
#ifndef VIEW_PALETTE_H
#define VIEW_PALETTE_H

#include <stdint.h>

#include "whit/whit.h"

enum { PALETTE_COLORS = 256 };
/* 0xAABBGGRR, from 0 to the scale; [PALETTE_COLORS] is the colour of NaN. */
struct palette {
    uint32_t colors[PALETTE_COLORS + 1];
};
WHIT_CHECK whit_result palette_init(struct palette *palette);

/* Cuts `width` x `height` pixels out of an image as displayed, from column `left` and row `top` on;
   `rgba` has room for 4 bytes a pixel. */
WHIT_CHECK whit_result palette_cut(const whit_image *image, uint32_t left, uint32_t top,
                                   uint32_t width, uint32_t height, uint8_t *rgba);

/* Paints `values`, of one channel, as whit_image_heat does, without its legend; `rgba` has room for
   4 bytes a pixel. */
WHIT_CHECK whit_result palette_heat(const whit_image *values, double scale, uint8_t *rgba);

/* Converts `values`, one a pixel, to colours; `rgba` has room for one word a pixel. */
void palette_paint(const struct palette *palette, const float *values, uint64_t count, double scale,
                   uint32_t *rgba);

/* Draws a bar of the colours, with numbers from 0 to `scale`, in a panel at the window's lower
   right. `id`: identifies the panel. */
void palette_legend(const struct palette *palette, const char *id, const char *title, double scale);

#endif

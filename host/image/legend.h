/* The legend below a heat map: a strip with title, colour bar and ticks. */
#ifndef IMAGE_LEGEND_H
#define IMAGE_LEGEND_H

#include "image/image.h"

enum { LEGEND_TEXT_MAX = 128 };
struct legend {
    uint32_t width, height; /* pixels of the strip; at least as wide as the picture */
    uint32_t zoom;          /* pixels of the picture for one of the font */
    double scale;           /* value at the right end */
    bool is_signed;         /* colours of heat_signed_color, -scale at the left end; else 0 there */
    char title[LEGEND_TEXT_MAX], unit[LEGEND_TEXT_MAX];
};

/* Makes the legend for a picture of this width. A title that is too long is cut. */
void legend_init(struct legend *legend, uint32_t picture_width, const char *title, const char *unit,
                 double scale);
/* Fills `to` (legend->width wide, RGB) with the background and draws the strip from row `top` on.
   `linear`: linear values of the 256 sRGB codes. */
void legend_draw(const struct legend *legend, const float linear[256], uint32_t top,
                 struct image *to);

#endif

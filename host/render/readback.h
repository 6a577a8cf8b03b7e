/* Reading pictures back from the device. */
#ifndef RENDER_READBACK_H
#define RENDER_READBACK_H

#include "render/renderer.h"

/* WHIT_ERROR_USAGE, logged, where the picture has no first sample, of which `what` would be. */
WHIT_CHECK whit_result readback_check_first(const struct renderer *renderer, const char *what);
/* Whether the picture stays on the device until it is asked for: it has one band and one pass. */
bool readback_is_late(const struct renderer *renderer);
/* Makes the images for a picture whose bands are read as they are drawn. */
WHIT_CHECK whit_result readback_make_images(struct renderer *renderer);
void readback_drop_images(struct renderer *renderer);
/* Reads row `y` of aov `index` into `to`, if readback_is_late. `row`: room for all aovs of a
   row. */
WHIT_CHECK whit_result readback_aov_row(const struct renderer *renderer, uint32_t index, uint32_t y,
                                        float *row, float *to);
/* Copies `rows` finished rows of the band, from row `band_y` of the picture on, from the device
   into the renderer's images. Ids are those of the first pass. */
WHIT_CHECK whit_result readback_band(struct renderer *renderer, const struct progress *progress,
                                     uint32_t band_y, uint32_t rows);
/* Counts the pixels of the band that are not finite so far; *x, *y: the first of them, in the
   picture. */
WHIT_CHECK whit_result readback_non_finite(const struct target *target, uint32_t *x, uint32_t *y,
                                           uint32_t *count);

#endif

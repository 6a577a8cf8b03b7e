/* What comes back from the device. */
#ifndef RENDER_READBACK_H
#define RENDER_READBACK_H

#include "render/renderer.h"

/* A picture of one band and one pass stays on the device until it is asked for. */
bool readback_is_late(const struct renderer *renderer);
/* Row `y` of an aov, where the picture is read late. `row`: room for all of them. */
WHIT_CHECK whit_result readback_aov_row(const struct renderer *renderer, uint32_t index, uint32_t y,
                                        float *row, float *to);
/* What the device holds of `rows` finished rows from `band_y` on, into the picture and the
   statistics. Ids are those of the first pass. */
WHIT_CHECK whit_result readback_band(struct renderer *renderer, const struct progress *progress,
                                     uint32_t band_y, uint32_t rows);
/* How many pixels of the band are not finite as yet, and in the picture the first of them. */
WHIT_CHECK whit_result readback_non_finite(const struct target *target, uint32_t *x, uint32_t *y,
                                           uint32_t *count);

#endif

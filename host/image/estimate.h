/* By how much a picture of some samples may be off, told by what more samples changed. */
#ifndef IMAGE_ESTIMATE_H
#define IMAGE_ESTIMATE_H

#include "image/image.h"

/* What doublings of samples changed: one channel, the largest of a pixel's channels. A later
   doubling lets an earlier one count for less, as changes become smaller.
   `halves`: the pictures of as many samples, whose mean is the picture. */
void estimate_note_change(const struct image *const halves[2], struct image *changes);

/* By how much each pixel may be off, in its worst channel: into `out`, zeroed, of one channel.
   `cuts`: of two channels, weights of rays that were not traced, of which each may have brought
   `cut_radiance`. Gives the root of the mean square over all pixels, and in *of_cuts
   what of it would be left if samples changed nothing. */
double estimate_error(const struct image *changes, const struct image *cuts, double cut_radiance,
                      struct image *out, double *of_cuts);

/* The mean radiance, largest channel, of rays of weights `sent` (as WHIT_AOV_CUTS, for bailout)
   that camera rays called for: `whole` with them, `own` without. Of camera rays where none was
   sent. */
double estimate_cut_radiance(const struct image *whole, const struct image *own,
                             const struct image *sent);

#endif

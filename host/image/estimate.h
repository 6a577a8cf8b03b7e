/* Estimates the error of a picture by how much its last doublings of samples changed it. */
#ifndef IMAGE_ESTIMATE_H
#define IMAGE_ESTIMATE_H

#include "image/image.h"

/* Updates `changes`, one channel: by how much the last doubling changed each pixel's worst channel,
   or a faded change of earlier doublings if that is larger. `halves`: the two pictures with equal
   numbers of samples whose mean is the new picture. */
void estimate_note_change(const struct image *const halves[2], struct image *changes);

/* Estimates the error of each pixel's worst channel into `out`, one channel. `cuts`, two channels:
   weights of rays that were not traced; each is assumed to carry `cut_radiance`. Gives the RMS over
   all pixels, and in *of_cuts the RMS of the part that is due to cut rays. */
double estimate_error(const struct image *changes, const struct image *cuts, double cut_radiance,
                      struct image *out, double *of_cuts);

/* The mean radiance, largest channel, of the rays that camera rays send on. `whole`: picture with
   these rays; `own`: the same without; `sent`: their weights, channel 1 of WHIT_AOV_CUTS of `own`.
   The mean radiance of camera rays where none is sent on. */
double estimate_cut_radiance(const struct image *whole, const struct image *own,
                             const struct image *sent);

#endif

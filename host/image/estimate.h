/* Estimates the error of a picture by how much its doublings of samples changed it. */
#ifndef IMAGE_ESTIMATE_H
#define IMAGE_ESTIMATE_H

#include "image/image.h"

/* Changes of a pixel's worst channel by doublings of samples. */
struct estimate_pixel {
    float first;        /* the sum of the first two changes */
    float before, last; /* the last two */
    /* Sums of squares of all changes, in which earlier ones fade quickly and slowly. */
    float quick, slow;
    float faded; /* by estimate_error: the root of a value between these two */
};

/* The changes that doublings of samples have brought to a picture so far. A record that is all zero
   may be given to estimate_finish. */
struct estimate {
    uint32_t width, height, doublings;
    struct estimate_pixel *pixels; /* row 0 is the top */
    double first, last;            /* means over all pixels of the first and of the last change */
};

/* Makes the record of a picture before its first doubling; estimate_finish releases it.
   WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result estimate_init(struct estimate *estimate, uint32_t width, uint32_t height);
void estimate_finish(struct estimate *estimate);

/* Notes a doubling. `halves`: the two pictures with equal numbers of samples whose mean is the new
   picture. */
void estimate_note_change(struct estimate *estimate, const struct image *const halves[2]);

/* Estimates the error of each pixel's worst channel into `out`, one channel, from one doubling on.
   `cuts`, two channels: weights of rays that were not traced; each is assumed to carry twice
   `cut_radiance`. Gives an estimate of the RMSE, and in *of_cuts the part of it that is due to cut
   rays. */
double estimate_error(struct estimate *estimate, const struct image *cuts, double cut_radiance,
                      struct image *out, double *of_cuts);

/* The mean radiance, largest channel, of the rays that camera rays send on. `whole`: picture with
   these rays; `own`: the same without; `sent`: their weights, channel 1 of WHIT_AOV_CUTS of `own`.
   The mean radiance of camera rays where none is sent on. */
double estimate_cut_radiance(const struct image *whole, const struct image *own,
                             const struct image *sent);

#endif

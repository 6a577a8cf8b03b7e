/* Estimates the error of a picture by how much its doublings of samples changed it. */
#ifndef IMAGE_ESTIMATE_H
#define IMAGE_ESTIMATE_H

#include "image/image.h"

enum { ESTIMATE_DOUBLINGS_MAX = 12 }; /* from 1 sample to WHIT_SAMPLES_MAX */

/* Changes of a pixel's worst channel by doublings of samples: 56 bytes a pixel. */
struct estimate_pixel {
    float changes[ESTIMATE_DOUBLINGS_MAX]; /* the first doubling's first */
    /* By estimate_error: the root of the sum of their squares, in which earlier ones fade; and by
       how much a neighbour must differ to be beyond an edge that no sample has seen. */
    float faded, seen;
};

/* The changes that doublings of samples have brought to a picture so far. A record that is all zero
   may be given to estimate_finish. */
struct estimate {
    uint32_t width, height, doublings, samples;
    struct estimate_pixel *pixels; /* row 0 is the top */
    double (*squares)[2]; /* by band of rows: sums of the squared errors, and of those by cuts */
    double first, last;   /* means over all pixels of the first and of the last change */
};

/* Makes the record of a picture before its first doubling; estimate_finish releases it.
   WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result estimate_init(struct estimate *estimate, uint32_t width, uint32_t height);
void estimate_finish(struct estimate *estimate);

/* Notes a doubling, at most ESTIMATE_DOUBLINGS_MAX of them. `halves`: the two pictures with
   `samples` samples each whose mean is the new picture. */
void estimate_note_change(struct estimate *estimate, const struct image *const halves[2],
                          uint32_t samples);

/* Estimates the error of each pixel's worst channel into `out`, one channel, from one doubling on.
   `picture`: of all samples. `cuts`, two channels: weights of rays that were not traced; each is
   assumed to carry twice `cut_radiance`. Gives an estimate of the RMSE, and in *of_cuts the part of
   it that is due to cut rays. */
double estimate_error(struct estimate *estimate, const struct image *picture,
                      const struct image *cuts, double cut_radiance, struct image *out,
                      double *of_cuts);

/* The mean radiance, largest channel, of the rays that camera rays send on. `whole`: picture with
   these rays; `own`: the same without; `sent`: their weights, channel 1 of WHIT_AOV_CUTS of `own`.
   The mean radiance of camera rays where none is sent on. */
double estimate_cut_radiance(const struct image *whole, const struct image *own,
                             const struct image *sent);

#endif

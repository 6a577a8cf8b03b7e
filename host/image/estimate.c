/* Samples are points of a sequence that fills the pixel more and more evenly (picture/sequence.h),
   so each doubling of samples changes a pixel less than the doubling before: by a rate of 0.7 where
   samples are like noise, and of 0.5 and less where an edge or a gradient crosses the pixel. The
   estimated error is larger where changes fall slowly. docs/accuracy.md, "The estimate of a refined
   picture", says how often it holds, and what else was tried. */
#include "image/estimate.h"

#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/same.h"

/* The constants below were fitted to the scenes in scenes/ at 64x48 and 92x60, where the estimate
   meets its goals in 43 and 45 of 54 cases. At 76x56, which had no part in that, it does in 41. */

/* The rate of a pixel, the factor by which its change falls from doubling to doubling, is taken to
   lie between these. */
#define RATE_LOW       0.36
#define RATE_HIGH      0.65
/* Each doubling multiplies the weight of earlier changes by the rate and by this: they were
   measured with fewer samples, and the signs of two changes are as likely to differ as not. */
#define FADES          0.8
/* The error of a pixel over the product of the picture's rate and the root of the weighted sum of
   its squared changes. */
#define ERROR_A_RATE   2.6
/* The radiance of rays that were cut, in units of the mean of those that were not: some of them
   would have met highlights. */
#define CUTS_CARRY     2.0
/* The estimate of a pixel is meant to be no less than its error in 95 % of the pixels, which is
   more than their root mean square needs: this part of it was no less than the RMSE in all of those
   cases, of all three sizes. */
#define RMS_PART       (1.0 / 1.5)
/* Keeps the square of a change finite. */
#define CHANGE_LARGEST 1e18f

whit_result estimate_init(struct estimate *estimate, uint32_t width, uint32_t height)
{
    *estimate = (struct estimate){.width = width, .height = height};
    estimate->pixels = array_alloc_zeroed((size_t)width * height, sizeof *estimate->pixels);
    return estimate->pixels ? WHIT_OK : WHIT_ERROR_MEMORY;
}

void estimate_finish(struct estimate *estimate)
{
    free(estimate->pixels);
    estimate->pixels = NULL;
}

/* Not-a-number, which is the difference of two infinite pixels, counts as no change. */
static float change_of(const float *a, const float *b)
{
    float largest =
        fmaxf(fmaxf(fabsf(a[0] - b[0]), fabsf(a[1] - b[1])), fmaxf(fabsf(a[2] - b[2]), 0.0f));
    return 0.5f * fminf(largest, CHANGE_LARGEST);
}

void estimate_note_change(struct estimate *estimate, const struct image *const halves[2])
{
    size_t count = (size_t)estimate->width * estimate->height;
    const float quick = (float)(FADES * RATE_LOW), slow = (float)(FADES * RATE_HIGH);
    double sum = 0.0;
    ++estimate->doublings;
    for (size_t i = 0; i < count; ++i) {
        float change = change_of(&halves[0]->pixels[halves[0]->channels * i],
                                 &halves[1]->pixels[halves[1]->channels * i]);
        struct estimate_pixel *pixel = &estimate->pixels[i];
        if (estimate->doublings <= 2)
            pixel->first += change;
        pixel->before = pixel->last;
        pixel->last = change;
        pixel->quick = change * change + quick * quick * pixel->quick;
        pixel->slow = change * change + slow * slow * pixel->slow;
        sum += (double)change;
    }
    estimate->last = sum / (double)count;
    if (estimate->doublings == 1)
        estimate->first = estimate->last;
}

/* Sums over the 3x3 pixels around (x, y), fewer at the border. */
struct around {
    double first, last_two, faded;
    uint32_t count;
};

static struct around sum_around(const struct estimate *estimate, uint32_t x, uint32_t y)
{
    uint32_t x0 = x > 0 ? x - 1 : 0, y0 = y > 0 ? y - 1 : 0;
    struct around sum = {0};
    for (uint32_t j = y0; j <= y + 1 && j < estimate->height; ++j) {
        for (uint32_t i = x0; i <= x + 1 && i < estimate->width; ++i, ++sum.count) {
            const struct estimate_pixel *pixel = &estimate->pixels[(size_t)j * estimate->width + i];
            sum.first += (double)pixel->first;
            sum.last_two += (double)pixel->before + (double)pixel->last;
            sum.faded += (double)pixel->faded;
        }
    }
    return sum;
}

/* By how much changes fall from doubling to doubling in the whole picture. The first change alone
   does not tell, and counts as one that does not fall. */
static double picture_rate(const struct estimate *estimate)
{
    if (!(estimate->last < estimate->first))
        return 1.0;
    return same_pow(estimate->last / estimate->first, 1.0 / (estimate->doublings - 1));
}

/* The rate around a pixel, by its first two and last two changes: 0 for RATE_LOW, 1 for RATE_HIGH,
   and between them by its logarithm. */
static double rate_around(const struct estimate *estimate, uint32_t x, uint32_t y)
{
    if (estimate->doublings <= 2)
        return 0.5;
    struct around sum = sum_around(estimate, x, y);
    double rate_log =
        same_log((sum.last_two + 1e-9) / (sum.first + 1e-9)) / (estimate->doublings - 2);
    double share = (rate_log - same_log(RATE_LOW)) / (same_log(RATE_HIGH) - same_log(RATE_LOW));
    return fmin(fmax(share, 0.0), 1.0);
}

static void fade(struct estimate *estimate)
{
    struct estimate_pixel *pixel = estimate->pixels;
    for (uint32_t y = 0; y < estimate->height; ++y) {
        for (uint32_t x = 0; x < estimate->width; ++x, ++pixel) {
            float share = (float)rate_around(estimate, x, y);
            pixel->faded = sqrtf(pixel->quick + share * (pixel->slow - pixel->quick));
        }
    }
}

/* The changes of a pixel alone may be small by chance, and the mean over its neighbours includes an
   edge beside it. So the estimate is own^(3/4) times mean^(1/4). */
double estimate_error(struct estimate *estimate, const struct image *cuts, double cut_radiance,
                      struct image *out, double *of_cuts)
{
    double rate = picture_rate(estimate), squares = 0.0, cut_squares = 0.0;
    size_t i = 0;
    fade(estimate);
    for (uint32_t y = 0; y < estimate->height; ++y) {
        for (uint32_t x = 0; x < estimate->width; ++x, ++i) {
            struct around sum = sum_around(estimate, x, y);
            double own = (double)estimate->pixels[i].faded, around = sum.faded / sum.count;
            double weight = (double)cuts->pixels[2 * i] + (double)cuts->pixels[2 * i + 1];
            double cut = CUTS_CARRY * weight * cut_radiance;
            double error = ERROR_A_RATE * rate * sqrt(own * sqrt(own * around)) + cut;
            out->pixels[i] = (float)error;
            squares += error * error;
            cut_squares += cut * cut;
        }
    }
    *of_cuts = RMS_PART * sqrt(cut_squares / (double)i);
    return RMS_PART * sqrt(squares / (double)i);
}

double estimate_cut_radiance(const struct image *whole, const struct image *own,
                             const struct image *sent)
{
    double brought = 0.0, weights = 0.0, seen = 0.0;
    size_t count = (size_t)whole->width * whole->height;
    for (size_t i = 0; i < count; ++i) {
        const float *all = &whole->pixels[whole->channels * i];
        const float *first = &own->pixels[own->channels * i];
        brought += (double)fmaxf(fmaxf(all[0] - first[0], all[1] - first[1]),
                                 fmaxf(all[2] - first[2], 0.0f));
        seen += (double)fmaxf(fmaxf(all[0], all[1]), fmaxf(all[2], 0.0f));
        weights += (double)sent->pixels[2 * i + 1]; /* channel 1: weights cut by the bail-out */
    }
    return weights > 0.0 ? brought / weights : seen / (double)count;
}

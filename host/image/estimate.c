/* Samples are points of a sequence that fills the pixel more and more evenly (picture/sequence.h),
   so each doubling of samples changes a pixel less than the doubling before. The estimated error is
   the sum of all changes to come. docs/accuracy.md, "The estimate of a refined picture", says how
   often that holds, and what else was tried. */
#include "image/estimate.h"

#include <math.h>

/* A doubling of samples changes a picture this many times as much as the doubling before: the
   median over the scenes in scenes/. */
#define CHANGE_FALLS    0.6f
/* The sum of all later changes, in units of the last one. It would be 2.5 (1 + 0.6 + 0.36 ...) if
   all changes had the same sign. */
#define CHANGES_TO_COME 1.5

static float largest_difference(const float *a, const float *b)
{
    return fmaxf(fmaxf(fabsf(a[0] - b[0]), fabsf(a[1] - b[1])), fabsf(a[2] - b[2]));
}

void estimate_note_change(const struct image *const halves[2], struct image *changes)
{
    size_t count = (size_t)changes->width * changes->height;
    uint32_t channels = halves[0]->channels;
    for (size_t i = 0; i < count; ++i) {
        float change = 0.5f * largest_difference(&halves[0]->pixels[channels * i],
                                                 &halves[1]->pixels[channels * i]);
        changes->pixels[i] = fmaxf(change, CHANGE_FALLS * changes->pixels[i]);
    }
}

/* The mean over the 3x3 pixels around (x, y), fewer at the border. */
static double mean_around(const struct image *image, uint32_t x, uint32_t y)
{
    uint32_t x0 = x > 0 ? x - 1 : 0, y0 = y > 0 ? y - 1 : 0, count = 0;
    double sum = 0.0;
    for (uint32_t j = y0; j <= y + 1 && j < image->height; ++j) {
        for (uint32_t i = x0; i <= x + 1 && i < image->width; ++i, ++count)
            sum += (double)image->pixels[(size_t)j * image->width + i];
    }
    return sum / count;
}

/* The change of a pixel alone may be small by chance, and the mean over its neighbours includes an
   edge beside it. So the estimate uses the geometric mean of both. */
double estimate_error(const struct image *changes, const struct image *cuts, double cut_radiance,
                      struct image *out, double *of_cuts)
{
    double squares = 0.0, cut_squares = 0.0;
    size_t i = 0;
    for (uint32_t y = 0; y < changes->height; ++y) {
        for (uint32_t x = 0; x < changes->width; ++x, ++i) {
            double change = sqrt((double)changes->pixels[i] * mean_around(changes, x, y));
            double weight = (double)cuts->pixels[2 * i] + (double)cuts->pixels[2 * i + 1];
            double cut = weight * cut_radiance, error = CHANGES_TO_COME * change + cut;
            out->pixels[i] = (float)error;
            squares += error * error;
            cut_squares += cut * cut;
        }
    }
    *of_cuts = sqrt(cut_squares / (double)i);
    return sqrt(squares / (double)i);
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

/* Samples are points of a sequence that fills the pixel more and more evenly (picture/sequence.h),
   so each doubling of samples changes a pixel less than the doubling before: by a rate of 0.7 where
   samples are like noise, and of 0.5 and less where an edge or a gradient crosses the pixel. The
   estimated error is larger where changes fall slowly, and where the pixels beside a pixel tell of
   an edge that its own samples may have missed. docs/accuracy.md, "The estimate of a refined
   picture", says how often it holds, and what else was tried. */
#include "image/estimate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/same.h"
#include "base/threads.h"

/* The constants below were fitted to the scenes in scenes/ at 64x48 and 92x60. */

/* The rate of a pixel, the factor by which its change falls from doubling to doubling, is taken to
   lie between these. Each doubling multiplies the weight of earlier changes by it. */
#define RATE_LOW       0.37
#define RATE_HIGH      0.7
/* The error of a pixel over the product of the picture's rate and the root of the weighted sum of
   its squared changes. */
#define ERROR_A_RATE   1.6
/* The changes of a pixel may be small by chance: they count as at least this part of the median
   over the 3x3 pixels around. An edge beside the pixel does not change that median much. */
#define MEDIAN_PART    0.8
/* A pixel that differs from its neighbour by this many times more than its samples differ among
   themselves is beside an edge, and has not seen it. A sample that differs by d from all others
   counts as d / 2. */
#define EDGE_TIMES     5.0
/* An edge that N samples missed cuts a corner that covers up to this many N-ths of the pixel. A
   strip along a side that they missed covers up to one. */
#define CORNER_SAMPLES 3.0
/* The radiance of rays that were cut, in units of the mean of those that were not: some of them
   would have met highlights. */
#define CUTS_CARRY     2.0
/* The estimate of a pixel is meant to be no less than its error in 95 % of the pixels, which is
   more than their root mean square needs: this part of it was no less than the RMSE in all of those
   cases, and at 76x56, which had no part in the fit. */
#define RMS_PART       (1.0 / 1.5)
/* Keeps the square of a change finite. */
#define CHANGE_LARGEST 1e18f

/* Rows that a thread works on at once. Sums are made by bands, so that they do not depend on the
   number of threads. */
enum { BAND_ROWS = 16 };

static uint32_t count_bands(const struct estimate *estimate)
{
    return (estimate->height + BAND_ROWS - 1) / BAND_ROWS;
}

whit_result estimate_init(struct estimate *estimate, uint32_t width, uint32_t height)
{
    *estimate = (struct estimate){.width = width, .height = height};
    estimate->pixels = array_alloc_zeroed((size_t)width * height, sizeof *estimate->pixels);
    estimate->squares = array_alloc(count_bands(estimate), sizeof *estimate->squares);
    if (estimate->pixels && estimate->squares)
        return WHIT_OK;
    estimate_finish(estimate);
    return WHIT_ERROR_MEMORY;
}

void estimate_finish(struct estimate *estimate)
{
    free(estimate->pixels);
    free(estimate->squares);
    estimate->pixels = NULL;
    estimate->squares = NULL;
}

/* The difference in the worst channel. Not-a-number, which is the difference of two infinite
   pixels, counts as none. */
static float difference_of(const float *a, const float *b)
{
    return fmaxf(fmaxf(fabsf(a[0] - b[0]), fabsf(a[1] - b[1])), fmaxf(fabsf(a[2] - b[2]), 0.0f));
}

void estimate_note_change(struct estimate *estimate, const struct image *const halves[2],
                          uint32_t samples)
{
    size_t count = (size_t)estimate->width * estimate->height;
    double sum = 0.0;
    for (size_t i = 0; i < count; ++i) {
        float difference = difference_of(&halves[0]->pixels[halves[0]->channels * i],
                                         &halves[1]->pixels[halves[1]->channels * i]);
        float change = 0.5f * fminf(difference, CHANGE_LARGEST);
        estimate->pixels[i].changes[estimate->doublings] = change;
        sum += (double)change;
    }
    estimate->last = sum / (double)count;
    if (estimate->doublings++ == 0)
        estimate->first = estimate->last;
    estimate->samples = 2 * samples;
}

/* The 3x3 pixels around a pixel, row by row: the pixel itself is number 4. Beyond the border are
   those at the border once more. */
struct around {
    size_t at[9];
};

static uint32_t clamp_place(uint32_t place_and_one, uint32_t count)
{
    uint32_t place = place_and_one > 0 ? place_and_one - 1 : 0;
    return place < count ? place : count - 1;
}

static struct around find_around(const struct estimate *estimate, uint32_t x, uint32_t y)
{
    struct around around;
    for (uint32_t i = 0; i < 9; ++i)
        around.at[i] = (size_t)clamp_place(y + i / 3, estimate->height) * estimate->width +
                       clamp_place(x + i % 3, estimate->width);
    return around;
}

/* By how much changes fall from doubling to doubling in the whole picture. The first change alone
   does not tell, and counts as one that does not fall. */
static double picture_rate(const struct estimate *estimate)
{
    if (!(estimate->last < estimate->first))
        return 1.0;
    return same_pow(estimate->last / estimate->first, 1.0 / (estimate->doublings - 1));
}

/* The rate around a pixel, by its first two and last two changes. */
static double rate_around(const struct estimate *estimate, const struct around *around)
{
    uint32_t count = estimate->doublings;
    double first = 1e-5, last = 1e-5;
    if (count <= 2)
        return sqrt(RATE_LOW * RATE_HIGH);
    for (int i = 0; i < 9; ++i) {
        const float *changes = estimate->pixels[around->at[i]].changes;
        first += (double)changes[0] + (double)changes[1];
        last += (double)changes[count - 2] + (double)changes[count - 1];
    }
    return fmin(fmax(same_pow(last / first, 1.0 / (count - 2)), RATE_LOW), RATE_HIGH);
}

/* Sets `faded` and `seen` of a pixel. An earlier change was measured with fewer samples, and its
   sign is as likely to be the other. */
static void sum_changes(const struct estimate *estimate, double rate, struct estimate_pixel *pixel)
{
    double faded = 0.0, seen = 0.0;
    for (uint32_t i = 0; i < estimate->doublings; ++i) {
        double square = (double)pixel->changes[i] * (double)pixel->changes[i];
        double half = estimate->samples >> (estimate->doublings - i); /* samples of a half */
        faded = faded * rate * rate + square;
        seen += square * half * half;
    }
    pixel->faded = (float)sqrt(faded);
    pixel->seen = (float)(EDGE_TIMES * sqrt(seen));
}

/* An estimate in the making; all that its bands read. */
struct estimating {
    struct estimate *estimate;
    const struct image *picture, *cuts;
    double rate, cut_radiance;
    struct image *out;
};

static uint32_t end_of_band(const struct estimate *estimate, uint32_t band)
{
    uint32_t left = estimate->height - band * BAND_ROWS;
    return band * BAND_ROWS + (left < BAND_ROWS ? left : BAND_ROWS);
}

static void fade_band(void *context, uint32_t band)
{
    struct estimate *estimate = ((struct estimating *)context)->estimate;
    for (uint32_t y = band * BAND_ROWS; y < end_of_band(estimate, band); ++y) {
        struct estimate_pixel *row = &estimate->pixels[(size_t)y * estimate->width];
        for (uint32_t x = 0; x < estimate->width; ++x) {
            const struct around around = find_around(estimate, x, y);
            sum_changes(estimate, rate_around(estimate, &around), &row[x]);
        }
    }
}

static float median_around(const struct estimate *estimate, const struct around *around)
{
    float sorted[9];
    for (int i = 0; i < 9; ++i) {
        float value = estimate->pixels[around->at[i]].faded;
        int place = i;
        for (; place > 0 && sorted[place - 1] > value; --place)
            sorted[place] = sorted[place - 1];
        sorted[place] = value;
    }
    return sorted[4];
}

/* The error by edges that the samples of a pixel missed. Such an edge cuts a corner if the pixels
   at both of its sides differ from this one. It leaves a strip along a side if the pixel at that
   side differs, and the samples there did not see the edge either. */
static double missed_at(const struct estimate *estimate, const struct image *picture,
                        const struct around *around)
{
    static const int sides[4] = {3, 5, 1, 7}; /* left, right, above, below */
    const struct estimate_pixel *pixels = estimate->pixels;
    double steps[4], strip = 0.0;
    for (int i = 0; i < 4; ++i) {
        size_t own = around->at[4], side = around->at[sides[i]];
        float difference = difference_of(&picture->pixels[picture->channels * own],
                                         &picture->pixels[picture->channels * side]);
        steps[i] =
            difference < CHANGE_LARGEST ? (double)difference - (double)pixels[own].seen : 0.0;
        strip = fmax(strip, steps[i] - (double)pixels[side].seen);
    }
    double corner = fmin(fmax(steps[0], steps[1]), fmax(steps[2], steps[3]));
    return (CORNER_SAMPLES * fmax(corner, 0.0) + strip) / estimate->samples;
}

static void estimate_pixel(const struct estimating *e, uint32_t x, uint32_t y, double squares[2])
{
    const struct estimate *estimate = e->estimate;
    const struct around around = find_around(estimate, x, y);
    size_t i = around.at[4];
    double changes = fmax((double)estimate->pixels[i].faded,
                          MEDIAN_PART * (double)median_around(estimate, &around));
    double weight = (double)e->cuts->pixels[2 * i] + (double)e->cuts->pixels[2 * i + 1];
    double cut = CUTS_CARRY * weight * e->cut_radiance;
    double error =
        ERROR_A_RATE * e->rate * changes + missed_at(estimate, e->picture, &around) + cut;
    e->out->pixels[i] = (float)error;
    squares[0] += error * error;
    squares[1] += cut * cut;
}

static void estimate_band(void *context, uint32_t band)
{
    const struct estimating *e = context;
    double squares[2] = {0.0, 0.0};
    for (uint32_t y = band * BAND_ROWS; y < end_of_band(e->estimate, band); ++y) {
        for (uint32_t x = 0; x < e->estimate->width; ++x)
            estimate_pixel(e, x, y, squares);
    }
    memcpy(e->estimate->squares[band], squares, sizeof squares);
}

double estimate_error(struct estimate *estimate, const struct image *picture,
                      const struct image *cuts, double cut_radiance, struct image *out,
                      double *of_cuts)
{
    uint32_t bands = count_bands(estimate);
    double count = (double)estimate->width * estimate->height, squares = 0.0, cut_squares = 0.0;
    struct estimating estimating = {.estimate = estimate,
                                    .picture = picture,
                                    .cuts = cuts,
                                    .rate = picture_rate(estimate),
                                    .cut_radiance = cut_radiance,
                                    .out = out};
    threads_for(0, bands, fade_band, &estimating);
    threads_for(0, bands, estimate_band, &estimating);
    for (uint32_t i = 0; i < bands; ++i) {
        squares += estimate->squares[i][0];
        cut_squares += estimate->squares[i][1];
    }
    *of_cuts = RMS_PART * sqrt(cut_squares / count);
    return RMS_PART * sqrt(squares / count);
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

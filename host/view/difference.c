#include "view/difference.h"

#include <math.h>
#include <stddef.h>

#include "whit/whit_compare.h"

static void measure_ids(const uint32_t *p, const uint32_t *q, struct difference *out)
{
    for (uint64_t i = 0; i < out->pixels; ++i)
        out->other_ids += p[2 * i] != q[2 * i] || p[2 * i + 1] != q[2 * i + 1];
}

static void measure_colors(const float *p, const float *q, uint32_t channels,
                           struct difference *out)
{
    uint32_t counted = channels < 3 ? channels : 3;
    double sum = 0.0;
    for (uint64_t i = 0; i < out->pixels; ++i) {
        bool other = false;
        for (uint64_t c = channels * i; c < channels * i + counted; ++c) {
            double d = fabs((double)p[c] - (double)q[c]);
            other = other || p[c] != q[c];
            sum += d;
            if (!(d <= out->largest))
                out->largest = d;
        }
        out->other_colors += other;
    }
    out->mean = out->pixels > 0 ? sum / (counted * (double)out->pixels) : 0.0;
}

void difference_measure(const struct difference_side *a, const struct difference_side *b,
                        struct difference *out)
{
    whit_image_info info;
    whit_image_get_info(a->color ? a->color : a->ids, &info);
    *out = (struct difference){.pixels = (uint64_t)info.width * info.height};
    if (a->ids && b->ids)
        measure_ids(whit_image_words(a->ids), whit_image_words(b->ids), out);
    if (a->color && b->color)
        measure_colors(whit_image_floats(a->color), whit_image_floats(b->color), info.channels,
                       out);
}

bool difference_flip(const whit_image *a, const whit_image *b, double *mean, double *largest)
{
    whit_difference difference;
    const whit_compare_params params = {0};
    bool known = whit_image_compare(a, b, &params, NULL, &difference, NULL) == WHIT_OK;
    *mean = known ? difference.flip_mean : 0.0;
    if (largest)
        *largest = known ? difference.flip_largest : 0.0;
    return known;
}

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

void difference_measure(const whit_image *color_a, const whit_image *color_b,
                        const whit_image *ids_a, const whit_image *ids_b, struct difference *out)
{
    whit_image_info info;
    whit_image_get_info(color_a ? color_a : ids_a, &info);
    *out = (struct difference){.pixels = (uint64_t)info.width * info.height};
    if (ids_a && ids_b)
        measure_ids(whit_image_words(ids_a), whit_image_words(ids_b), out);
    if (color_a && color_b)
        measure_colors(whit_image_floats(color_a), whit_image_floats(color_b), info.channels, out);
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

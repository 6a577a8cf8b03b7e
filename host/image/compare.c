#include <math.h>
#include <string.h>

#include "image/image.h"

struct sums {
    double squares;
    uint64_t terms;
};

static bool same_kind(const struct image *a, const struct image *b)
{
    return a->width == b->width && a->height == b->height && a->channels == b->channels &&
           !a->pixels == !b->pixels && !a->words == !b->words;
}

static bool is_finite(const float *pixel, uint32_t channels)
{
    for (uint32_t c = 0; c < channels; ++c) {
        if (!isfinite(pixel[c]))
            return false;
    }
    return true;
}

/* Alpha, the fourth channel, is not encoded. */
static bool is_over_1_255(const float *a, const float *b, uint32_t channels)
{
    /* Pictures with 8 bits that lie one step apart are not over it. */
    const float limit = 1.0f / 255.0f + 1e-6f;
    for (uint32_t c = 0; c < channels; ++c) {
        float difference =
            c == 3 ? a[c] - b[c] : image_srgb_from_linear(a[c]) - image_srgb_from_linear(b[c]);
        if (fabsf(difference) > limit)
            return true;
    }
    return false;
}

static void add_colours(const float *a, const float *b, uint32_t channels,
                        struct image_difference *out, struct sums *sums)
{
    uint32_t colours = channels < 3 ? channels : 3;
    for (uint32_t c = 0; c < colours; ++c) {
        double difference = (double)a[c] - (double)b[c];
        sums->squares += difference * difference;
        out->largest = fmax(out->largest, fabs(difference));
    }
    sums->terms += colours;
}

static void compare_pixel(const float *a, const float *b, uint32_t channels,
                          struct image_difference *out, struct sums *sums)
{
    bool finite_a = is_finite(a, channels), finite_b = is_finite(b, channels);
    bool differ = memcmp(a, b, channels * sizeof(float)) != 0;
    out->nonfinite_a += !finite_a;
    out->nonfinite_b += !finite_b;
    out->differing_pixels += differ;
    if (finite_a && finite_b)
        add_colours(a, b, channels, out, sums);
    if (differ && (!finite_a || !finite_b || is_over_1_255(a, b, channels)))
        ++out->over_1_255;
}

static void compare_words(const uint32_t *a, const uint32_t *b, uint32_t channels,
                          struct image_difference *out, struct sums *sums)
{
    bool differ = memcmp(a, b, channels * sizeof(uint32_t)) != 0;
    ++sums->terms;
    if (!differ)
        return;
    ++out->differing_pixels;
    ++out->over_1_255;
    out->largest = 1.0;
    sums->squares += 1.0;
}

whit_result image_compare(const struct log *log, const struct image *a, const struct image *b,
                          struct image_difference *out)
{
    *out = (struct image_difference){0};
    if (!same_kind(a, b)) {
        log_error(log,
                  "the pictures cannot be compared: %u x %u with %u %s against %u x %u with %u %s",
                  a->width, a->height, a->channels, a->words ? "integers" : "floats", b->width,
                  b->height, b->channels, b->words ? "integers" : "floats");
        return WHIT_ERROR_INPUT;
    }
    struct sums sums = {0};
    out->pixel_count = (uint64_t)a->width * a->height;
    for (size_t i = 0; i < out->pixel_count; ++i) {
        size_t at = i * a->channels;
        if (a->pixels)
            compare_pixel(a->pixels + at, b->pixels + at, a->channels, out, &sums);
        else if (a->words)
            compare_words(a->words + at, b->words + at, a->channels, out, &sums);
    }
    out->rmse = sums.terms ? sqrt(sums.squares / (double)sums.terms) : 0.0;
    return WHIT_OK;
}

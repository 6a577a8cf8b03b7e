#include <math.h>
#include <string.h>

#include "base/color.h"
#include "image/compare.h"

struct sums {
    double squares, relative_squares, differences[3];
    uint64_t terms;
};

/* Pixel `index` as RGBA: grey fills three channels, alpha is 1 where there is none. */
static void read_pixel(const struct image *image, size_t index, float rgba[4])
{
    const float *pixel = image->pixels + index * image->channels;
    for (uint32_t c = 0; c < 3; ++c)
        rgba[c] = pixel[image->channels < 3 ? 0 : c];
    rgba[3] = image->channels == 4 ? pixel[3] : 1.0f;
}

void image_displayed_pixel(const struct image *image, size_t index, float rgba[4])
{
    read_pixel(image, index, rgba);
    for (uint32_t c = 0; c < 3 && image->display_scale != 0.0f; ++c)
        rgba[c] *= image->display_scale;
    for (uint32_t c = 0; c < 3 && image->display_soft; ++c)
        rgba[c] = color_shoulder(rgba[c]);
}

/* Whether two images can be compared: same size, and both floats, or both integers with the same
   number of channels. */
static bool same_kind(const struct image *a, const struct image *b)
{
    return a->width == b->width && a->height == b->height && !a->pixels == !b->pixels &&
           !a->words == !b->words && (!a->words || a->channels == b->channels);
}

static whit_result refuse(const whit_log *log, const struct image *a, const struct image *b)
{
    return log_failure(
        log, WHIT_ERROR_INPUT,
        "the pictures cannot be compared: %u x %u with %u %s against %u x %u with %u %s", a->width,
        a->height, a->channels, a->words ? "integers" : "floats", b->width, b->height, b->channels,
        b->words ? "integers" : "floats");
}

static bool is_finite(const float rgba[4])
{
    return isfinite(rgba[0]) && isfinite(rgba[1]) && isfinite(rgba[2]) && isfinite(rgba[3]);
}

/* Whether a channel of pixel `i` differs by over 1/255; colours are compared in sRGB. */
static bool is_over_1_255(const struct image *image_a, const struct image *image_b, size_t i)
{
    float a[4], b[4];
    image_displayed_pixel(image_a, i, a);
    image_displayed_pixel(image_b, i, b);
    /* 1e-6 more, so that 8-bit codes that are one step apart are not over it by rounding. */
    const float limit = 1.0f / 255.0f + 1e-6f;
    for (uint32_t c = 0; c < 4; ++c) {
        float difference =
            c == 3 ? a[c] - b[c] : image_srgb_from_linear(a[c]) - image_srgb_from_linear(b[c]);
        if (fabsf(difference) > limit)
            return true;
    }
    return false;
}

static void add_colours(const float a[4], const float b[4], whit_difference *out, struct sums *sums)
{
    for (uint32_t c = 0; c < 3; ++c) {
        double reference = a[c], difference = (double)b[c] - reference;
        sums->squares += difference * difference;
        sums->relative_squares +=
            difference * difference / (reference * reference + IMAGE_RELATIVE_FLOOR);
        sums->differences[c] += difference;
        out->largest = fmax(out->largest, fabs(difference));
    }
    ++sums->terms;
}

static void compare_pixel(const struct image *image_a, const struct image *image_b, size_t i,
                          whit_difference *out, struct sums *sums)
{
    float a[4], b[4];
    read_pixel(image_a, i, a);
    read_pixel(image_b, i, b);
    bool finite_a = is_finite(a), finite_b = is_finite(b);
    bool differ = memcmp(a, b, 4 * sizeof(float)) != 0;
    out->nonfinite_a += !finite_a;
    out->nonfinite_b += !finite_b;
    out->differing_pixels += differ;
    if (finite_a && finite_b)
        add_colours(a, b, out, sums);
    bool unlike = differ && !(finite_a && finite_b);
    out->nonfinite_differing += unlike;
    out->over_1_255 += unlike || (differ && is_over_1_255(image_a, image_b, i));
}

static void compare_words(const uint32_t *a, const uint32_t *b, uint32_t channels,
                          whit_difference *out, struct sums *sums)
{
    bool differ = memcmp(a, b, channels * sizeof(uint32_t)) != 0;
    ++sums->terms;
    if (!differ)
        return;
    ++out->differing_pixels;
    ++out->over_1_255;
    out->largest = 1.0;
    sums->squares += 3.0;
}

static void divide(const struct sums *sums, whit_difference *out)
{
    double terms = sums->terms ? (double)sums->terms : 1.0;
    out->rmse = sqrt(sums->squares / (3.0 * terms));
    out->relative_mse = sums->relative_squares / (3.0 * terms);
    for (int c = 0; c < 3; ++c)
        out->mean[c] = sums->differences[c] / terms;
}

whit_result image_compare(const whit_log *log, const struct image *a, const struct image *b,
                          whit_difference *out)
{
    *out = (whit_difference){0};
    if (!same_kind(a, b))
        return refuse(log, a, b);
    struct sums sums = {0};
    out->pixel_count = (uint64_t)a->width * a->height;
    for (size_t i = 0; i < out->pixel_count; ++i) {
        size_t at = i * a->channels;
        if (a->words)
            compare_words(a->words + at, b->words + at, a->channels, out, &sums);
        else if (a->pixels)
            compare_pixel(a, b, i, out, &sums);
    }
    divide(&sums, out);
    return WHIT_OK;
}

whit_result image_subtract(const whit_log *log, const struct image *a, const struct image *b,
                           struct image *out)
{
    *out = (struct image){0};
    if (!same_kind(a, b))
        return refuse(log, a, b);
    if (!a->pixels)
        return log_failure(log, WHIT_ERROR_USAGE,
                           "hit identities have no difference but that they are other ones");
    whit_result result = image_init_logged(log, out, a->width, a->height, 3, false);
    if (result != WHIT_OK)
        return result;
    size_t count = (size_t)a->width * a->height;
    for (size_t i = 0; i < count; ++i) {
        float p[4], q[4];
        read_pixel(a, i, p);
        read_pixel(b, i, q);
        bool finite = is_finite(p) && is_finite(q);
        for (uint32_t c = 0; c < 3; ++c)
            out->pixels[3 * i + c] = finite ? q[c] - p[c] : NAN;
    }
    return WHIT_OK;
}

#include "image/heat.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/vec.h"
#include "image/legend.h"

/* Every 15th of the 256 colours of viridis (S. van der Walt and N. Smith, 2015; released into the
   public domain with matplotlib 1.5 as CC0). Linear interpolation between them is off by at most 5
   codes. */
static const uint32_t viridis[18] = {
    0x440154, 0x481769, 0x472a7a, 0x433d84, 0x3d4e8a, 0x355e8d, 0x2e6d8e, 0x297b8e, 0x23898e,
    0x1f978b, 0x21a585, 0x2eb37c, 0x46c06f, 0x65cb5e, 0x89d548, 0xb0dd2f, 0xd8e219, 0xfde725,
};
enum { LAST = 17 };

void heat_color(double share, uint8_t codes[3])
{
    double at = (share > 0.0 ? fmin(share, 1.0) : 0.0) * LAST;
    int below = at < LAST ? (int)at : LAST - 1;
    double part = at - below;
    for (int c = 0; c < 3; ++c) {
        int shift = 16 - 8 * c;
        double low = (double)(viridis[below] >> shift & 255);
        double high = (double)(viridis[below + 1] >> shift & 255);
        codes[c] = (uint8_t)(low + (high - low) * part + 0.5);
    }
}

/* Colours for values above 0 and below, each from 0 to the end of the scale. whit's own, not one of
   the published scales. */
static const uint8_t sides[2][3][3] = {
    {{0xf4, 0xf4, 0xf4}, {0x5c, 0x9f, 0xd6}, {0x0a, 0x2c, 0x6e}},
    {{0xf4, 0xf4, 0xf4}, {0xe0, 0x8a, 0x3c}, {0x66, 0x24, 0x06}},
};

void heat_signed_color(double share, uint8_t codes[3])
{
    double at = share > 0.0 ? fmin(share, 1.0) : share < 0.0 ? fmin(-share, 1.0) : 0.0;
    const uint8_t(*side)[3] = sides[share > 0.0];
    int below = at < 0.5 ? 0 : 1;
    double part = 2.0 * at - below;
    for (int c = 0; c < 3; ++c) {
        double low = side[below][c], high = side[below + 1][c];
        codes[c] = (uint8_t)(low + (high - low) * part + 0.5);
    }
}

/* Rounds up to the next of a few round numbers. */
static double round_up(double value)
{
    static const double nice[] = {1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0};
    double power = pow(10.0, floor(log10(value)));
    for (size_t i = 0; i < sizeof nice / sizeof nice[0]; ++i) {
        if (value <= nice[i] * power * (1.0 + 1e-12))
            return nice[i] * power;
    }
    return 10.0 * power;
}

/* A key that sorts floats: the bits of positive floats have their order. Others give 0. */
static uint32_t order_of(float value)
{
    return value > 0.0f ? float_bits(value) : 0;
}

enum { HALF_COUNT = 1 << 16 };

/* Finds the 16-bit half that holds the value of rank *rank; makes *rank the rank within that
   half. */
static uint32_t find_half(const uint64_t counts[HALF_COUNT], uint64_t *rank)
{
    uint32_t half = 0;
    while (half + 1 < HALF_COUNT && *rank > counts[half])
        *rank -= counts[half++];
    return half;
}

/* The value farthest from 0 among three channels, with its sign; NaN where any is NaN. */
static float farthest(const float *pixel)
{
    float value = pixel[0];
    for (int c = 1; c < 3; ++c)
        value = isnan(value) || fabsf(value) >= fabsf(pixel[c]) ? value : pixel[c];
    return value;
}

static float value_at(const struct image *values, size_t i)
{
    const float *pixel = values->pixels + i * values->channels;
    return values->channels < 3 ? pixel[0] : farthest(pixel);
}

/* The scale is made of these: the value, or with `is_signed` its distance from 0. */
static float size_at(const struct image *values, bool is_signed, size_t i)
{
    float value = value_at(values, i);
    return is_signed ? fabsf(value) : value;
}

/* The finite size of rank `rank` (from 1), by radix selection: first the upper 16 bits, then the
   lower ones. */
static float size_of_rank(const struct image *values, bool is_signed, uint64_t rank,
                          uint64_t counts[HALF_COUNT])
{
    size_t count = (size_t)values->width * values->height;
    uint32_t upper = 0;
    for (int lower = 0; lower < 2; ++lower) {
        memset(counts, 0, HALF_COUNT * sizeof *counts);
        for (size_t i = 0; i < count; ++i) {
            float size = size_at(values, is_signed, i);
            uint32_t bits = order_of(size);
            if (isfinite(size) && (!lower || bits >> 16 == upper))
                ++counts[lower ? bits & (HALF_COUNT - 1) : bits >> 16];
        }
        upper = upper << 16 | find_half(counts, &rank);
    }
    return float_of_bits(upper);
}

static double largest_of(const struct image *values, bool is_signed, uint64_t *finite_count)
{
    double largest = 0.0;
    size_t count = (size_t)values->width * values->height;
    *finite_count = 0;
    for (size_t i = 0; i < count; ++i) {
        float size = size_at(values, is_signed, i);
        *finite_count += isfinite(size) ? 1 : 0;
        largest = isfinite(size) ? fmax(largest, (double)size) : largest;
    }
    return largest;
}

static double scale_of(const struct image *values, bool is_signed)
{
    uint64_t finite_count;
    double scale = largest_of(values, is_signed, &finite_count);
    uint64_t *counts = array_alloc(HALF_COUNT, sizeof *counts);
    if (counts && finite_count) {
        uint64_t rank = finite_count - finite_count / 200;
        double value = (double)size_of_rank(values, is_signed, rank, counts);
        scale = value > 0.0 ? value : scale;
    }
    free(counts); /* without memory for counts the largest value is the scale */
    return scale > 0.0 ? round_up(scale) : 1.0;
}

double image_heat_scale(const struct image *values)
{
    return values->pixels && values->channels == 1 ? scale_of(values, false) : 1.0;
}

struct painter {
    float linear[256]; /* by sRGB code */
    double scale;
    bool is_signed;
};

static void put_heat(const struct painter *painter, float value, float *to)
{
    uint8_t codes[3];
    if (!isfinite(value)) {
        to[0] = to[1] = to[2] = NAN;
        return;
    }
    double share = (double)value / painter->scale;
    if (painter->is_signed)
        heat_signed_color(share, codes);
    else
        heat_color(share, codes);
    for (int c = 0; c < 3; ++c)
        to[c] = painter->linear[codes[c]];
}

static bool can_paint(const struct image *values, const whit_heat_params *params)
{
    bool channels = values->channels == 1 || (params->is_signed && values->channels >= 3);
    return values->pixels && channels && params->scale >= 0.0 && isfinite(params->scale);
}

whit_result image_heat(const struct image *values, const whit_heat_params *params,
                       struct image *out)
{
    *out = (struct image){0};
    if (!can_paint(values, params))
        return WHIT_ERROR_USAGE;
    struct legend legend;
    struct painter painter = {.scale = params->scale, .is_signed = params->is_signed};
    if (!(painter.scale > 0.0))
        painter.scale = scale_of(values, params->is_signed);
    legend_init(&legend, values->width, params->title, params->unit, painter.scale);
    legend.is_signed = params->is_signed;
    if (values->height > UINT32_MAX - legend.height)
        return WHIT_ERROR_MEMORY;
    whit_result result = image_init(out, legend.width, values->height + legend.height, 3, false);
    if (result != WHIT_OK)
        return result;
    for (int code = 0; code < 256; ++code)
        painter.linear[code] = image_linear_from_srgb((float)code / 255.0f);
    legend_draw(&legend, painter.linear, values->height, out);
    uint32_t left = (legend.width - values->width) / 2;
    for (uint32_t y = 0; y < values->height; ++y) {
        for (uint32_t x = 0; x < values->width; ++x)
            put_heat(&painter, value_at(values, (size_t)y * values->width + x),
                     out->pixels + 3 * ((size_t)y * out->width + left + x));
    }
    return WHIT_OK;
}

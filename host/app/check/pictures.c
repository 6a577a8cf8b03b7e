#include "app/check/pictures.h"

#include <stdlib.h>
#include <string.h>

#include "app/check/draw.h"
#include "base/array.h"

enum { THUMBNAIL_SIDE = 96, SIDE_MIN = 8, DIFFERENCE_TIMES = 8 };

static whit_result out_of_memory(void)
{
    return CLI_FAIL(WHIT_ERROR_MEMORY, "out of memory for small pictures");
}

/* ---- Smaller pictures ---- */

/* A side divided by a whole number; one pixel where it is shorter than that. */
static uint32_t divided(uint32_t side, uint32_t by)
{
    return side < by ? 1 : side / by;
}

static uint32_t at_most(uint32_t number, uint32_t limit)
{
    return number < limit ? number : limit;
}

/* The mean of a square of `by` x `by` pixels, or of those of it that the image has, for `channels`
   channels. */
static void average(const whit_image *image, const whit_image_info *info, uint32_t x, uint32_t y,
                    uint32_t by, uint32_t channels, float *out)
{
    const float *floats = whit_image_floats(image);
    double sum[3] = {0.0};
    uint32_t rows = at_most(by, info->height), columns = at_most(by, info->width);
    for (uint32_t row = y * by; row < y * by + rows; ++row) {
        for (uint32_t column = x * by; column < x * by + columns; ++column) {
            const float *pixel = floats + ((size_t)row * info->width + column) * info->channels;
            for (uint32_t k = 0; k < channels; ++k)
                sum[k] += (double)pixel[k];
        }
    }
    for (uint32_t k = 0; k < channels; ++k)
        out[k] = (float)(sum[k] / ((double)rows * (double)columns));
}

/* Averages squares of `by` x `by` pixels, without alpha; incomplete squares at the right and bottom
   are cut, but a side shorter than `by` becomes one pixel. */
static whit_result shrink(const whit_image *image, uint32_t by, const whit_renderer_params *params,
                          whit_image **out)
{
    whit_image_info info;
    whit_image_get_info(image, &info);
    uint32_t width = divided(info.width, by), height = divided(info.height, by),
             channels = info.channels < 3 ? 1 : 3;
    float *pixels = array_alloc((size_t)width * height * channels, sizeof *pixels);
    for (uint32_t y = 0; pixels && y < height; ++y) {
        for (uint32_t x = 0; x < width; ++x)
            average(image, &info, x, y, by, channels, pixels + ((size_t)y * width + x) * channels);
    }
    whit_result result =
        pixels ? whit_image_create(width, height, channels, pixels, out) : WHIT_ERROR_MEMORY;
    free(pixels);
    if (result != WHIT_OK)
        return out_of_memory();
    if (params)
        whit_image_display_as(*out, params);
    return WHIT_OK;
}

static uint32_t longer_side(const whit_image_info *info)
{
    return info->width > info->height ? info->width : info->height;
}

static void png_finish(struct check_png *png)
{
    whit_memory_destroy(png->data);
    *png = (struct check_png){.data = NULL};
}

/* Makes a PNG of at most `bytes_max`: the image divided by `by`, `by` + 1 and so on until it fits
   or its longer side would be below SIDE_MIN, where a larger PNG is taken. */
static whit_result encode(const whit_image *image, uint32_t by, const whit_renderer_params *params,
                          size_t bytes_max, struct check_png *png)
{
    whit_image_info info;
    whit_image_get_info(image, &info);
    whit_result result = WHIT_OK;
    for (;; ++by) {
        whit_image *small = NULL;
        bool last = longer_side(&info) / (by + 1) < SIDE_MIN;
        result = shrink(image, by, params, &small);
        if (result == WHIT_OK)
            result = whit_image_encode_png(small, NULL, 0, &cli_log, &png->data, &png->size_bytes);
        whit_image_destroy(small);
        if (result != WHIT_OK || png->size_bytes <= bytes_max || last)
            return result;
        png_finish(png);
    }
}

/* ---- Of a drawing ---- */

whit_result check_pictures_make(struct check_pictures *pictures, const struct drawing *drawing)
{
    whit_image_info info;
    whit_image *heat = NULL;
    const whit_heat_params heat_params = {.title = "costs"};
    const whit_image *image = drawing->color;
    whit_image_get_info(image, &info);
    whit_result result = info.channels == 1 ? whit_image_heat(image, &heat_params, &heat) : WHIT_OK;
    image = heat ? heat : image;
    const whit_renderer_params *params = heat ? NULL : &drawing->params;
    if (result == WHIT_OK)
        result = encode(image, 1, params, PICTURE_BYTES_MAX, &pictures->after);
    uint32_t by = (longer_side(&info) + THUMBNAIL_SIDE - 1) / THUMBNAIL_SIDE;
    if (result == WHIT_OK)
        result = encode(image, by, params, THUMBNAIL_BYTES_MAX, &pictures->thumbnail);
    whit_image_destroy(heat);
    return result;
}

/* The RGBA bytes that a PNG of the image has; free() it. NULL: out of memory. */
static uint8_t *display(const whit_image *image, const whit_image_info *info)
{
    uint8_t *bytes = array_alloc((size_t)info->width * info->height, 4);
    if (bytes)
        whit_image_display_bytes(image, bytes);
    return bytes;
}

/* Makes two images: `after` as a PNG would show it, and its difference from `before`. */
static whit_result show_both(const whit_image *before, const whit_image *after,
                             const whit_image_info *info, whit_image **shown,
                             whit_image **difference)
{
    uint8_t *a = display(before, info), *b = display(after, info);
    whit_result result = a && b ? WHIT_OK : WHIT_ERROR_MEMORY;
    if (result == WHIT_OK)
        result = whit_image_create_display(info->width, info->height, b, shown);
    for (size_t i = 0; result == WHIT_OK && i < 4 * (size_t)info->width * info->height; ++i) {
        int other = DIFFERENCE_TIMES * abs(a[i] - b[i]);
        b[i] = (uint8_t)(other < 255 ? other : 255);
    }
    if (result == WHIT_OK)
        result = whit_image_create_display(info->width, info->height, b, difference);
    free(a);
    free(b);
    return result == WHIT_OK ? result : out_of_memory();
}

/* Both images have the size in `info`. */
static whit_result compare(struct check_pictures *pictures, const whit_image *before,
                           const whit_image *after, const whit_image_info *info)
{
    whit_difference found;
    whit_image *shown = NULL, *difference = NULL, *map = NULL;
    whit_result result = show_both(before, after, info, &shown, &difference);
    if (result == WHIT_OK)
        result = whit_image_compare(before, shown, NULL, &cli_log, &found, &map);
    if (result == WHIT_OK)
        result = encode(before, 1, NULL, PICTURE_BYTES_MAX, &pictures->before);
    if (result == WHIT_OK)
        result = encode(difference, 1, NULL, PICTURE_BYTES_MAX, &pictures->difference);
    if (result == WHIT_OK)
        result = encode(map, 1, NULL, PICTURE_BYTES_MAX, &pictures->flip);
    if (result == WHIT_OK)
        pictures->flip_mean = found.flip_mean;
    whit_image_destroy(shown);
    whit_image_destroy(difference);
    whit_image_destroy(map);
    return result;
}

whit_result check_pictures_compare(struct check_pictures *pictures, const struct drawing *drawing,
                                   const whit_image *before)
{
    whit_image_info now, then;
    whit_image *small;
    whit_image_get_info(drawing->color, &now);
    whit_image_get_info(before, &then);
    uint32_t by = longer_side(&then) ? longer_side(&now) / longer_side(&then) : 0;
    if (!by || divided(now.width, by) != then.width || divided(now.height, by) != then.height ||
        now.channels < 3)
        return WHIT_OK;
    whit_result result = shrink(drawing->color, by, &drawing->params, &small);
    if (result != WHIT_OK)
        return result;
    result = compare(pictures, before, small, &then);
    whit_image_destroy(small);
    return result;
}

void check_pictures_finish(struct check_pictures *pictures)
{
    png_finish(&pictures->thumbnail);
    png_finish(&pictures->after);
    png_finish(&pictures->before);
    png_finish(&pictures->difference);
    png_finish(&pictures->flip);
}

#include <stdlib.h>
#include <string.h>

#include "api/handles.h"
#include "base/array.h"
#include "base/same.h"
#include "image/compare.h"
#include "image/display.h"
#include "image/flip.h"
#include "image/heat.h"
#include "image/image_reply.h"
#include "image/rows.h"
#include "whit/whit_program.h"

void whit_image_get_info(const whit_image *image, whit_image_info *info)
{
    *info = (whit_image_info){
        .width = image->image.width,
        .height = image->image.height,
        .channels = image->image.channels,
        .integers = image->image.words != NULL,
    };
}

const float *whit_image_floats(const whit_image *image)
{
    return image->image.pixels;
}

const uint32_t *whit_image_words(const whit_image *image)
{
    return image->image.words;
}

whit_result whit_image_rows(const whit_image *image, uint32_t first, uint32_t count,
                            whit_image **out)
{
    const struct image *from = &image->image;
    *out = NULL;
    if (count == 0 || first > from->height || count > from->height - first)
        return WHIT_ERROR_USAGE;
    struct image to;
    whit_result result = image_init(&to, from->width, count, from->channels, from->words != NULL);
    if (result != WHIT_OK)
        return result;
    to.display_scale = from->display_scale;
    to.display_soft = from->display_soft;
    size_t row = (size_t)from->width * from->channels, bytes = row * count * sizeof(uint32_t);
    if (from->words)
        memcpy(to.words, from->words + row * first, bytes);
    else
        memcpy(to.pixels, from->pixels + row * first, bytes);
    return api_hand_out(NULL, &to, WHIT_OK, out);
}

whit_result whit_image_create_display(uint32_t width, uint32_t height, const uint8_t *rgba,
                                      whit_image **out)
{
    size_t pixel_count = (size_t)width * height;
    struct image image;
    whit_result result = image_init(&image, width, height, 3, false);
    for (size_t i = 0; result == WHIT_OK && i < 3 * pixel_count; ++i)
        image.pixels[i] = image_linear_from_srgb((float)rgba[i / 3 * 4 + i % 3] * (1.0f / 255.0f));
    return api_hand_out(NULL, &image, result, out);
}

void whit_image_display_bytes(const whit_image *image, uint8_t *rgba)
{
    if (image->image.pixels)
        display_bytes(&image->image, rgba);
}

void whit_image_display_as(whit_image *image, const whit_renderer_params *params)
{
    const whit_renderer_params taken = api_params(params);
    image->image.display_scale = (float)same_pow(2.0, taken.exposure_ev);
    image->image.display_soft = taken.soft_highlights;
}

whit_result whit_image_save(const whit_image *image, const char *path, const whit_text *texts,
                            uint32_t text_count, const whit_log *log)
{
    return whit_image_save_layers(image, NULL, 0, path, texts, text_count, log);
}

whit_result whit_image_save_layers(const whit_image *image, const whit_image_layer *layers,
                                   uint32_t layer_count, const char *path, const whit_text *texts,
                                   uint32_t text_count, const whit_log *log)
{
    struct image_layer items[WHIT_LAYERS_MAX];
    if (!path)
        return API_FAIL(log, WHIT_ERROR_USAGE, "there is no path of a file to write");
    for (uint32_t i = 0; i < layer_count && i < WHIT_LAYERS_MAX; ++i)
        items[i] = (struct image_layer){layers[i].name, &layers[i].image->image};
    return image_save(log, &image->image, items, layer_count, path, texts, text_count);
}

whit_result whit_image_strips_begin(const char *path, const whit_image *like, uint32_t height,
                                    const whit_text *texts, uint32_t text_count,
                                    const whit_log *log, whit_image_strips **out)
{
    struct image shape = like->image;
    shape.height = height;
    return image_rows_begin(log, path, &shape, texts, text_count, out);
}

whit_result whit_image_strips_add(whit_image_strips *strips, const whit_image *strip)
{
    return image_rows_add(strips, &strip->image);
}

whit_result whit_image_strips_commit(whit_image_strips *strips)
{
    return image_rows_commit(strips);
}

void whit_image_strips_abandon(whit_image_strips *strips)
{
    image_rows_abandon(strips);
}

float *whit_image_edit(whit_image *image)
{
    return image->image.pixels;
}

whit_result whit_image_encode_png(const whit_image *image, const whit_text *texts,
                                  uint32_t text_count, const whit_log *log, uint8_t **data,
                                  size_t *size_bytes)
{
    return image_encode_png(log, &image->image, texts, text_count, data, size_bytes);
}

whit_result whit_image_load_texts(const char *path, const whit_load_params *params,
                                  const whit_log *log, whit_text **texts, uint32_t *text_count)
{
    const struct foreign_params foreign = load_foreign(params);
    whit_result result = load_check(log, path, params);
    return result == WHIT_OK ? image_load_texts(log, path, &foreign, texts, text_count) : result;
}

uint64_t whit_memory_limit(const whit_load_params *params)
{
    uint64_t limit = params->memory_limit_bytes;
    return limit ? limit : scene_default_memory_limit();
}

whit_result whit_image_load(const char *path, const whit_load_params *params, const whit_log *log,
                            whit_image **out)
{
    const struct foreign_params foreign = load_foreign(params);
    struct image image = {0};
    whit_result result = load_check(log, path, params);
    if (result == WHIT_OK)
        result = image_load(log, NULL, path, &foreign, &image);
    return api_hand_out(log, &image, result, out);
}

whit_result whit_image_create(uint32_t width, uint32_t height, uint32_t channels,
                              const float *pixels, whit_image **out)
{
    *out = NULL;
    if (width == 0 || height == 0 || (channels != 1 && channels != 3 && channels != 4))
        return WHIT_ERROR_USAGE;
    struct image image;
    whit_result result = image_init(&image, width, height, channels, false);
    if (result == WHIT_OK)
        memcpy(image.pixels, pixels, (size_t)width * height * channels * sizeof *pixels);
    return api_hand_out(NULL, &image, result, out);
}

whit_image *whit_image_share(whit_image *image)
{
    if (image)
        atomic_fetch_add(&image->sharers, 1);
    return image;
}

void whit_image_destroy(whit_image *image)
{
    if (!image || atomic_fetch_sub(&image->sharers, 1) > 0)
        return;
    image_finish(&image->image);
    free(image);
}

bool whit_image_format_known(const char *path, bool integers)
{
    return image_format_known(path, integers);
}

double whit_image_heat_scale(const whit_image *values)
{
    return image_heat_scale(&values->image);
}

whit_result whit_image_heat(const whit_image *values, const whit_heat_params *params,
                            whit_image **out)
{
    const whit_heat_params defaults = {0};
    if (!params)
        params = &defaults;
    struct image image = {0};
    whit_result result = image_heat(&values->image, params, &image);
    return api_hand_out(NULL, &image, result, out);
}

static whit_result compare_by_flip(const whit_image *a, const whit_image *b,
                                   const whit_compare_params *params, const whit_log *log,
                                   whit_difference *out, whit_image **flip_map)
{
    struct flip_summary flip;
    struct image map = {0};
    whit_result result = image_flip(&a->image, &b->image, params->pixels_per_degree, &map, &flip);
    if (result == WHIT_ERROR_USAGE)
        log_error(log, "%g pixels a degree: must be 1 to %d", params->pixels_per_degree,
                  FLIP_PIXELS_PER_DEGREE_MAX);
    out->flip_mean = flip.mean;
    out->flip_largest = flip.largest;
    if (flip_map)
        return api_hand_out(NULL, &map, result, flip_map);
    image_finish(&map);
    return result;
}

whit_result whit_image_compare(const whit_image *a, const whit_image *b,
                               const whit_compare_params *params, const whit_log *log,
                               whit_difference *out, whit_image **flip_map)
{
    const whit_compare_params defaults = {0};
    if (!params)
        params = &defaults;
    if (flip_map)
        *flip_map = NULL;
    whit_result result = image_compare(log, &a->image, &b->image, out);
    if (result != WHIT_OK)
        return result;
    if (params->no_flip || !a->image.pixels)
        return WHIT_OK;
    return compare_by_flip(a, b, params, log, out, flip_map);
}

whit_result whit_image_subtract(const whit_image *a, const whit_image *b, const whit_log *log,
                                whit_image **out)
{
    struct image image = {0};
    whit_result result = image_subtract(log, &a->image, &b->image, &image);
    return api_hand_out(NULL, &image, result, out);
}

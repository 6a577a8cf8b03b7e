#include <stdlib.h>
#include <string.h>

#include "api/handles.h"
#include "image/heat.h"

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

whit_result whit_image_save(const whit_image *image, const char *path, const whit_text *texts,
                            uint32_t text_count, const whit_log *log)
{
    struct log inner = log_from_public(log);
    struct image_text *copies = calloc(text_count ? text_count : 1, sizeof *copies);
    if (!copies) {
        log_error(&inner, "%s: out of memory", path);
        return WHIT_ERROR_MEMORY;
    }
    for (uint32_t i = 0; i < text_count; ++i)
        copies[i] = (struct image_text){.key = texts[i].key, .value = texts[i].value};
    whit_result result = image_save(&inner, &image->image, path, copies, text_count);
    free(copies);
    return result;
}

whit_result whit_image_load(const char *path, const whit_log *log, whit_image **out)
{
    struct log inner = log_from_public(log);
    *out = NULL;
    whit_image *image = calloc(1, sizeof *image);
    if (!image) {
        log_error(&inner, "%s: out of memory", path);
        return WHIT_ERROR_MEMORY;
    }
    whit_result result = image_load(&inner, path, &image->image);
    if (result != WHIT_OK) {
        whit_image_destroy(image);
        return result;
    }
    *out = image;
    return WHIT_OK;
}

whit_result whit_image_create(uint32_t width, uint32_t height, uint32_t channels,
                              const float *pixels, whit_image **out)
{
    *out = NULL;
    if (width == 0 || height == 0 || (channels != 1 && channels != 3 && channels != 4))
        return WHIT_ERROR_USAGE;
    whit_image *image = calloc(1, sizeof *image);
    if (!image)
        return WHIT_ERROR_MEMORY;
    whit_result result = image_init(&image->image, width, height, channels, false);
    if (result != WHIT_OK) {
        whit_image_destroy(image);
        return result;
    }
    memcpy(image->image.pixels, pixels, (size_t)width * height * channels * sizeof *pixels);
    *out = image;
    return WHIT_OK;
}

void whit_image_destroy(whit_image *image)
{
    if (!image)
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
    *out = NULL;
    whit_image *image = calloc(1, sizeof *image);
    if (!image)
        return WHIT_ERROR_MEMORY;
    const struct heat_params inner = {
        .scale = params->scale,
        .title = params->title,
        .unit = params->unit,
    };
    whit_result result = image_heat(&values->image, &inner, &image->image);
    if (result != WHIT_OK) {
        whit_image_destroy(image);
        return result;
    }
    *out = image;
    return WHIT_OK;
}

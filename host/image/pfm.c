/* Portable float map: "PF" or "Pf", width, height, scale (negative: little-endian), one white
   space, then rows of floats from the bottom up. http://www.pauldebevec.com/Research/HDR/PFM/ */
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/text.h"
#include "image/formats.h"

static void put_float(uint8_t *to, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 4; ++i)
        to[i] = (uint8_t)(bits >> (8 * i));
}

static float get_float(const uint8_t *from, bool little_endian)
{
    uint32_t bits = 0;
    for (int i = 0; i < 4; ++i)
        bits |= (uint32_t)from[i] << (8 * (little_endian ? i : 3 - i));
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static uint32_t kept_channels(const struct image *image)
{
    return image->channels == 1 ? 1 : 3;
}

size_t pfm_put_header(const struct image_target *target, const struct image *shape)
{
    int bytes = fprintf(target->stream, "%s\n%u %u\n-1.0\n",
                        kept_channels(shape) == 1 ? "Pf" : "PF", shape->width, shape->height);
    return bytes > 0 ? (size_t)bytes : 0;
}

whit_result pfm_put_rows(const struct image_target *target, const struct image *image)
{
    uint32_t colours = kept_channels(image);
    size_t row_bytes = (size_t)image->width * colours * 4;
    uint8_t *row = array_alloc(row_bytes, 1);
    if (!row)
        return log_failure(target->log, WHIT_ERROR_MEMORY, "%s: no memory for a row of pixels",
                           target->path);
    for (uint32_t y = image->height; y-- > 0;) {
        const float *pixel = image->pixels + (size_t)y * image->width * image->channels;
        for (uint32_t x = 0; x < image->width; ++x, pixel += image->channels) {
            for (uint32_t c = 0; c < colours; ++c)
                put_float(row + ((size_t)x * colours + c) * 4, pixel[c]);
        }
        fwrite(row, 1, row_bytes, target->stream);
    }
    free(row);
    return WHIT_OK;
}

/* Reads the next word of the header, and skips the one white space behind it. */
static bool next_word(const struct image_source *source, size_t *at, char *word, size_t word_bytes)
{
    while (*at < source->size_bytes && isspace(source->data[*at]))
        ++*at;
    size_t length = 0;
    while (*at < source->size_bytes && !isspace(source->data[*at])) {
        if (length + 1 >= word_bytes)
            return false;
        word[length++] = (char)source->data[(*at)++];
    }
    word[length] = 0;
    if (length == 0 || *at >= source->size_bytes)
        return false;
    ++*at;
    return true;
}

static bool parse_size(const char *word, uint64_t *size)
{
    char *end;
    if (!isdigit((unsigned char)word[0]))
        return false;
    *size = strtoul(word, &end, 10);
    return *end == 0 && *size > 0;
}

static bool parse_header(const struct image_source *source, size_t *at, uint64_t size[2],
                         double *scale)
{
    char word[32];
    char *end;
    if (!next_word(source, at, word, sizeof word) || strlen(word) != 2)
        return false;
    for (int i = 0; i < 2; ++i) {
        if (!next_word(source, at, word, sizeof word) || !parse_size(word, &size[i]))
            return false;
    }
    if (!next_word(source, at, word, sizeof word))
        return false;
    *scale = text_real(word, &end);
    return *end == 0 && isfinite(*scale) && *scale != 0.0;
}

whit_result pfm_load(const struct image_source *source, struct image *image)
{
    size_t at = 0;
    uint64_t size[2];
    double scale;
    uint32_t channels = source->data[1] == 'F' ? 3 : 1;
    if (!parse_header(source, &at, size, &scale))
        return log_failure(source->log, WHIT_ERROR_INPUT, "%s: the PFM header is damaged",
                           source->path);
    /* Checked before memory is allocated. Sizes that overflow here are refused there. */
    uint64_t needed_bytes = size[0] * size[1] * channels * 4;
    bool countable = size[0] <= IMAGE_SIDE_MAX && size[1] <= IMAGE_SIDE_MAX;
    if (countable && source->size_bytes - at < needed_bytes)
        return log_failure(source->log, WHIT_ERROR_INPUT,
                           "%s: cut short: %zu of %llu bytes of pixels", source->path,
                           source->size_bytes - at, (unsigned long long)needed_bytes);
    whit_result result = image_init_loaded(source, image, size[0], size[1], channels, false);
    if (result != WHIT_OK)
        return result;
    size_t row_values = (size_t)image->width * channels;
    const uint8_t *from = source->data + at;
    for (uint32_t y = image->height; y-- > 0;) {
        float *row = image->pixels + y * row_values;
        for (size_t i = 0; i < row_values; ++i, from += 4)
            row[i] = get_float(from, scale < 0.0);
    }
    return WHIT_OK;
}

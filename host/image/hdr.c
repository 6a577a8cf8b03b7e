/* Reads Radiance RGBE pictures: G. Ward, "Real Pixels", Graphics Gems II, 1991; file layout by
   Radiance's filefmts.pdf. Rows are plain pixels, or run-length coded by component. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "image/formats.h"

struct reader {
    const uint8_t *at, *end;
};

/* Reads one line without its newline; false at the end of the file and for lines that are too
   long. */
static bool next_line(struct reader *reader, char *line, size_t line_bytes)
{
    size_t length = 0;
    while (reader->at < reader->end && *reader->at != '\n') {
        if (length + 1 >= line_bytes)
            return false;
        line[length++] = (char)*reader->at++;
    }
    if (reader->at >= reader->end)
        return false;
    ++reader->at;
    if (length && line[length - 1] == '\r')
        --length;
    line[length] = 0;
    return true;
}

static bool read_header(struct reader *reader)
{
    char line[512];
    bool known = false;
    while (next_line(reader, line, sizeof line)) {
        if (line[0] == 0)
            return known;
        if (strcmp(line, "FORMAT=32-bit_rle_rgbe") == 0)
            known = true;
    }
    return false;
}

struct layout {
    uint64_t width, height;
    bool bottom_up, right_to_left;
};

static bool read_layout(struct reader *reader, struct layout *layout)
{
    char line[128], rest;
    char sign_y, sign_x;
    unsigned long width, height;
    if (!next_line(reader, line, sizeof line) ||
        sscanf(line, "%cY %9lu %cX %9lu%c", &sign_y, &height, &sign_x, &width, &rest) != 4)
        return false;
    if ((sign_y != '-' && sign_y != '+') || (sign_x != '-' && sign_x != '+'))
        return false;
    layout->width = width;
    layout->height = height;
    layout->bottom_up = sign_y == '+';
    layout->right_to_left = sign_x == '-';
    return true;
}

/* Reads one component of a run-length coded row: counts over 128 are runs, others literal bytes. */
static bool read_runs(struct reader *reader, uint8_t *to, uint32_t width)
{
    for (uint32_t x = 0; x < width;) {
        if (reader->end - reader->at < 2)
            return false;
        uint32_t count = *reader->at++;
        bool run = count > 128;
        if (run)
            count -= 128;
        if (count == 0 || count > width - x ||
            (size_t)(reader->end - reader->at) < (run ? 1 : count))
            return false;
        for (uint32_t i = 0; i < count; ++i)
            to[4 * (x + i)] = run ? reader->at[0] : reader->at[i];
        reader->at += run ? 1 : count;
        x += count;
    }
    return true;
}

/* Reads a row of plain pixels, in which a pixel 1, 1, 1, n repeats the one before n times. Of
   several such marks in sequence the i-th repeats n * 256^i times. */
static bool read_old_row(struct reader *reader, uint8_t *row, uint32_t width)
{
    uint32_t shift = 0;
    for (uint32_t x = 0; x < width;) {
        if (reader->end - reader->at < 4)
            return false;
        const uint8_t *pixel = reader->at;
        reader->at += 4;
        if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
            memcpy(row + 4 * (size_t)x++, pixel, 4);
            shift = 0;
            continue;
        }
        if (x == 0 || shift > 16)
            return false;
        uint64_t count = (uint64_t)pixel[3] << shift;
        if (count > width - x)
            return false;
        for (; count; --count, ++x)
            memcpy(row + 4 * (size_t)x, row + 4 * (size_t)(x - 1), 4);
        shift += 8;
    }
    return true;
}

static bool read_row(struct reader *reader, uint8_t *row, uint32_t width)
{
    const uint8_t *at = reader->at;
    bool coded = reader->end - at >= 4 && at[0] == 2 && at[1] == 2 && at[2] < 128 && width >= 8 &&
                 width < 32768;
    if (!coded)
        return read_old_row(reader, row, width);
    if (((uint32_t)at[2] << 8 | at[3]) != width)
        return false;
    reader->at += 4;
    for (int c = 0; c < 4; ++c) {
        if (!read_runs(reader, row + c, width))
            return false;
    }
    return true;
}

static void store_row(const uint8_t *row, const struct layout *layout, uint32_t y,
                      struct image *image)
{
    uint32_t to_y = layout->bottom_up ? image->height - 1 - y : y;
    float *to = image->pixels + (size_t)to_y * image->width * 3;
    for (uint32_t x = 0; x < image->width; ++x) {
        const uint8_t *pixel = row + 4 * (size_t)x;
        float scale = pixel[3] ? ldexpf(1.0f, pixel[3] - 136) : 0.0f;
        float *out = to + 3 * (size_t)(layout->right_to_left ? image->width - 1 - x : x);
        for (int c = 0; c < 3; ++c)
            out[c] = (float)pixel[c] * scale;
    }
}

whit_result hdr_load(const struct image_source *source, struct image *image)
{
    struct reader reader = {.at = source->data, .end = source->data + source->size_bytes};
    struct layout layout;
    if (!read_header(&reader) || !read_layout(&reader, &layout))
        return log_failure(source->log, WHIT_ERROR_INPUT,
                           "%s: the HDR header is damaged, or of a kind not supported",
                           source->path);
    /* A row has at least 4 bytes; checked, so that a short file does not allocate much memory. */
    if (layout.height > (uint64_t)(reader.end - reader.at) / 4)
        return log_failure(source->log, WHIT_ERROR_INPUT, "%s: cut short", source->path);
    whit_result result = image_init_loaded(source, image, layout.width, layout.height, 3, false);
    if (result != WHIT_OK)
        return result;
    uint8_t *row = array_alloc(image->width, 4);
    if (!row)
        return log_failure(source->log, WHIT_ERROR_MEMORY, "%s: no memory for a row of pixels",
                           source->path);
    for (uint32_t y = 0; y < image->height && result == WHIT_OK; ++y) {
        if (read_row(&reader, row, image->width)) {
            store_row(row, &layout, y, image);
            continue;
        }
        log_error(source->log, "%s: row %u is damaged or cut short", source->path, y);
        result = WHIT_ERROR_INPUT;
    }
    free(row);
    return result;
}

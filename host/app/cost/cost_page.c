/* The report of `whit cost` as one page: page.html, which draws itself from the JSON that stands in
   it. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/cost/cost.h"
#include "whit/whit_program.h"

/* ---- Pictures ---- */

/* RFC 4648, behind what `to` has. */
static void put_base64(FILE *to, const uint8_t *data, size_t size_bytes)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size_bytes; i += 3) {
        size_t left = size_bytes - i;
        uint32_t bits = (uint32_t)data[i] << 16 | (left > 1 ? (uint32_t)data[i + 1] << 8 : 0) |
                        (left > 2 ? data[i + 2] : 0);
        fputc(digits[bits >> 18], to);
        fputc(digits[bits >> 12 & 63], to);
        fputc(left > 1 ? digits[bits >> 6 & 63] : '=', to);
        fputc(left > 2 ? digits[bits & 63] : '=', to);
    }
}

/* The image as a PNG in a URI of data; null where it cannot be made. */
static void put_image(json_t *object, const char *key, const whit_image *image)
{
    uint8_t *data = NULL;
    size_t size_bytes, length;
    char *uri = NULL;
    FILE *to = NULL;
    if (whit_image_encode_png(image, NULL, 0, NULL, &data, &size_bytes) == WHIT_OK)
        to = open_memstream(&uri, &length);
    if (to) {
        fputs("data:image/png;base64,", to);
        put_base64(to, data, size_bytes);
        fclose(to);
    }
    document_text(object, key, uri);
    free(uri);
    whit_memory_destroy(data);
}

/* null for a row without a picture of its own. */
static json_t *picture_document(const struct cost_row *row, bool usual)
{
    const whit_heat_params heat = {.scale = 1.0, .title = "FLIP", .unit = "0: looks the same"};
    whit_image *map = NULL;
    if (!row->picture || !row->flip || (!usual && row->pixels_changed == 0))
        return json_null();
    json_t *out = document_object();
    put_image(out, "color", row->picture);
    if (whit_image_heat(row->flip, &heat, &map) == WHIT_OK)
        put_image(out, "flip", map);
    whit_image_destroy(map);
    return out;
}

/* ---- The crop ---- */

enum { CROP_SHARE = 5, CROP_MIN = 32, CROP_STEP = 8 };

static double sum_of(const whit_image *map, const whit_image_info *info, uint32_t x, uint32_t y,
                     uint32_t width, uint32_t height)
{
    double sum = 0.0;
    for (uint32_t row = y; row < y + height; ++row)
        for (uint32_t column = x; column < x + width; ++column)
            sum += (double)whit_image_floats(map)[(size_t)row * info->width + column];
    return sum;
}

/* A fifth of the picture on each side, where the usual picture is most visibly wrong. */
static json_t *crop_document(const struct cost_report *report)
{
    uint32_t width = report->judged_width, height = report->judged_height, best_x = 0, best_y = 0;
    uint32_t w = width / CROP_SHARE > CROP_MIN ? width / CROP_SHARE : CROP_MIN;
    uint32_t h = height / CROP_SHARE > CROP_MIN ? height / CROP_SHARE : CROP_MIN;
    const whit_image *map = report->rows[0].flip;
    double most = -1.0;
    whit_image_info info;
    w = w < width ? w : width;
    h = h < height ? h : height;
    if (map)
        whit_image_get_info(map, &info);
    for (uint32_t y = 0; map && y + h <= height; y += CROP_STEP) {
        for (uint32_t x = 0; x + w <= width; x += CROP_STEP) {
            double sum = sum_of(map, &info, x, y, w, h);
            if (sum > most) {
                most = sum;
                best_x = x;
                best_y = y;
            }
        }
    }
    json_t *out = document_object();
    document_count(out, "x", best_x);
    document_count(out, "y", best_y);
    document_count(out, "width", w);
    document_count(out, "height", h);
    return out;
}

/* ---- The page ---- */

static void say_text(void *user, const char *sentence)
{
    json_t *holder = document_object();
    document_text(holder, "text", sentence);
    document_append(user, json_incref(json_object_get(holder, "text")));
    json_decref(holder);
}

static json_t *page_document(const struct cost_report *report)
{
    json_t *out = document_object(), *pictures = document_array(), *answers = document_array(),
           *method = document_array();
    for (uint32_t i = 0; i < report->row_count; ++i)
        document_append(pictures, picture_document(&report->rows[i], i == 0));
    if (report->reference)
        put_image(out, "reference", report->reference);
    cost_say_answers(report, say_text, answers);
    cost_say_method(report, say_text, method);
    document_put(out, "crop", crop_document(report));
    document_put(out, "pictures", pictures);
    document_put(out, "answers", answers);
    document_put(out, "method", method);
    return out;
}

/* JSON inside of HTML: no `<` of a text may end the element. */
static void put_report(FILE *to, const char *line)
{
    for (; *line; ++line)
        if (*line == '<')
            fputs("\\u003c", to);
        else
            fputc(*line, to);
}

whit_result cost_save_page(const struct cost *cost)
{
    static const char mark[] = "@REPORT@";
    const char *template = cost_page_html, *at = strstr(template, mark);
    json_t *document = cost_document(cost);
    char *text = NULL;
    size_t bytes = 0;
    document_put(document, "page", page_document(cost->report));
    char *line = document_line(document);
    FILE *to = line ? open_memstream(&text, &bytes) : NULL;
    if (to) {
        fwrite(template, 1, (size_t)(at - template), to);
        put_report(to, line);
        fputs(at + strlen(mark), to);
    }
    whit_result result = WHIT_ERROR_MEMORY;
    if (to && fclose(to) == 0)
        result = whit_file_write(cost->html, text, bytes, &cli_log);
    else
        cli_error("out of memory");
    free(text);
    free(line);
    return result;
}

/* The report of `whit cost` as one page: page.html, which draws itself from the JSON that stands in
   it. */
#include "app/cost/cost_json.h"
#include "app/cost/cost_table.h"
#include "app/page.h"

/* ---- Pictures ---- */

/* The image as a PNG in a URI of data; null where it cannot be made. */
static void put_image(json_t *object, const char *key, const whit_image *image)
{
    uint8_t *data = NULL;
    size_t size_bytes = 0;
    if (whit_image_encode_png(image, NULL, 0, NULL, &data, &size_bytes) != WHIT_OK)
        data = NULL;
    page_put_png(object, key, data, size_bytes);
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

whit_result cost_save_page(const struct cost *cost)
{
    json_t *document = cost_document(cost);
    document_put(document, "page", page_document(cost->report));
    return page_save(cost_page_html, document, cost->html);
}

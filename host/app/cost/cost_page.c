/* The report of `whit cost` as a single HTML file: page.html, whose script draws it from the JSON
   embedded in it. */
#include "app/cost/cost_json.h"
#include "app/cost/cost_table.h"
#include "app/page.h"

/* ---- Pictures ---- */

/* Adds the image as a PNG in a data URI; null where it cannot be made. */
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

static void put_crop(json_t *out, const struct cost_report *report)
{
    const struct cost_crop crop = cost_crop(report);
    document_count(out, "x", crop.x);
    document_count(out, "y", crop.y);
    document_count(out, "width", crop.width);
    document_count(out, "height", crop.height);
}

/* ---- The page ---- */

static void say_text(void *user, const char *sentence)
{
    document_append_text(user, sentence);
}

static void put_page(json_t *out, const struct cost_report *report)
{
    if (report->reference)
        put_image(out, "reference", report->reference);
    put_crop(document_child(out, "crop"), report);
    json_t *pictures = document_list(out, "pictures");
    for (uint32_t i = 0; i < report->row_count; ++i)
        document_append(pictures, picture_document(&report->rows[i], i == 0));
    cost_say_answers(report, say_text, document_list(out, "answers"));
    cost_say_method(report, say_text, document_list(out, "method"));
}

whit_result cost_save_page(const struct cost *cost)
{
    json_t *document = cost_document(cost->report, cost);
    put_page(document_child(document, "page"), cost->report);
    return page_save(cost_page_html, document, cost->html);
}

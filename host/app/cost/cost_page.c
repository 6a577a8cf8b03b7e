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

static json_t *crop_document(const struct cost_report *report)
{
    const struct cost_crop crop = cost_crop(report);
    json_t *out = document_object();
    document_count(out, "x", crop.x);
    document_count(out, "y", crop.y);
    document_count(out, "width", crop.width);
    document_count(out, "height", crop.height);
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
    json_t *out = document_object();
    if (report->reference)
        put_image(out, "reference", report->reference);
    document_put(out, "crop", crop_document(report));
    json_t *pictures = document_list(out, "pictures");
    for (uint32_t i = 0; i < report->row_count; ++i)
        document_append(pictures, picture_document(&report->rows[i], i == 0));
    cost_say_answers(report, say_text, document_list(out, "answers"));
    cost_say_method(report, say_text, document_list(out, "method"));
    return out;
}

whit_result cost_save_page(const struct cost *cost)
{
    json_t *document = cost_document(cost);
    document_put(document, "page", page_document(cost->report));
    return page_save(cost_page_html, document, cost->html);
}

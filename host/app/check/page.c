/* A run of `whit check` as a single HTML file: page.html, whose script draws it from the JSON
   embedded in it. */
#include <stdlib.h>
#include <string.h>

#include "app/check/check.h"
#include "app/page.h"

/* Limit on a page with its pictures: those that do not fit are left out, in the order of
   put_pictures. */
enum { PAGE_BYTES_MAX = 1000000, ENTRY_BYTES = 64 };

static size_t size_of(const struct check_png *png)
{
    return png->data ? (png->size_bytes + 2) / 3 * 4 + ENTRY_BYTES : 0;
}

/* Adds a PNG if there is room for it in *left. */
static bool put_png(json_t *object, const char *key, const struct check_png *png, size_t *left)
{
    size_t bytes = size_of(png);
    if (!bytes || bytes > *left)
        return false;
    page_put_png(object, key, png->data, png->size_bytes);
    *left -= bytes;
    return true;
}

static bool is_wrong(const struct check_result *result)
{
    return result->verdict >= CHECK_ACCEPTED;
}

/* Adds pictures while there is room: first the old picture and the differences of each case, then
   thumbnails, then, in place of the thumbnail, the full picture of each case that is not fine. */
static void put_pictures(const struct check *check, json_t **objects, size_t left)
{
    uint32_t count = check->suite.count;
    for (uint32_t i = 0; i < count; ++i) {
        const struct check_pictures *pictures = &check->results[i].pictures;
        if (!objects[i] || !put_png(objects[i], "before", &pictures->before, &left))
            continue;
        put_png(objects[i], "difference", &pictures->difference, &left);
        put_png(objects[i], "flip", &pictures->flip, &left);
        document_number(objects[i], "flip_mean", pictures->flip_mean);
    }
    for (uint32_t i = 0; i < count; ++i) {
        if (objects[i])
            put_png(objects[i], "after", &check->results[i].pictures.thumbnail, &left);
    }
    for (uint32_t i = 0; i < count; ++i) {
        if (objects[i] && is_wrong(&check->results[i]))
            put_png(objects[i], "after", &check->results[i].pictures.after, &left);
    }
}

/* Removes what the page does not show. */
static void drop_keys(json_t *object, bool is_shown_whole)
{
    static const char *const keys[] = {"golden", "is",      "expects", "command",
                                       "was",    "changed", "cause"};
    enum { NEVER_SHOWN = 3 }; /* the first ones; the others only for cases that are not fine */
    for (size_t i = 0; i < (is_shown_whole ? NEVER_SHOWN : sizeof keys / sizeof *keys); ++i)
        json_object_del(object, keys[i]);
}

/* Finds the JSON object of each case of the suite; NULL: the case was not run. */
static void find_objects(const struct check *check, json_t *cases, json_t **objects)
{
    size_t at = 0;
    for (uint32_t i = 0; i < check->suite.count; ++i) {
        bool run = check->results[i].verdict != CHECK_NOT_RUN;
        objects[i] = run ? json_array_get(cases, at++) : NULL;
        drop_keys(objects[i], is_wrong(&check->results[i]));
    }
}

whit_result check_save_page(const struct check *check, int status)
{
    json_t *document = check_document(check, status);
    json_t **objects = calloc(check->suite.count, sizeof *objects);
    if (!objects) {
        json_decref(document);
        return cli_no_memory();
    }
    find_objects(check, json_object_get(document, "cases"), objects);
    char *line = document_line(json_incref(document));
    size_t used = strlen(check_page_html) + strlen(line);
    free(line);
    put_pictures(check, objects, used < PAGE_BYTES_MAX ? PAGE_BYTES_MAX - used : 0);
    free(objects);
    return page_save(check_page_html, document, check->report);
}

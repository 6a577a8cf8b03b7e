#include "app/page.h"

#include <stdlib.h>
#include <string.h>

/* Appends base64 (RFC 4648) to `to`. */
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

void page_put_png(json_t *object, const char *key, const uint8_t *data, size_t size_bytes)
{
    size_t length;
    char *uri = NULL;
    FILE *to = data ? open_memstream(&uri, &length) : NULL;
    if (to) {
        fputs("data:image/png;base64,", to);
        put_base64(to, data, size_bytes);
        fclose(to);
    }
    document_text(object, key, uri);
    free(uri);
}

struct page {
    const char *html, *line;
};

/* Replaces @REPORT@. In JSON each `<` is escaped, as `</script>` in a text would end the element.
 */
static void put_page(FILE *to, const void *user)
{
    static const char mark[] = "@REPORT@";
    const struct page *page = user;
    const char *at = strstr(page->html, mark);
    fwrite(page->html, 1, (size_t)(at - page->html), to);
    for (const char *c = page->line; *c; ++c)
        if (*c == '<')
            fputs("\\u003c", to);
        else
            fputc(*c, to);
    fputs(at + strlen(mark), to);
}

whit_result page_save(const char *html, json_t *document, const char *path)
{
    char *line = document_line(document);
    const struct page page = {html, line};
    whit_result result = document_save_written(path, put_page, &page);
    free(line);
    return result;
}

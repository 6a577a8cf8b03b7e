#include "app/page.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Text ---- */

static bool reserve(struct page *page, size_t more)
{
    if (page->failed)
        return false;
    if (more < page->capacity - page->length && page->text)
        return true;
    size_t capacity = 2 * (page->length + more) + 4096;
    char *text = realloc(page->text, capacity);
    page->failed = !text;
    if (!text)
        return false;
    page->text = text;
    page->text[page->length] = 0;
    page->capacity = capacity;
    return true;
}

static void append(struct page *page, const char *text, size_t length)
{
    if (!reserve(page, length + 1))
        return;
    memcpy(page->text + page->length, text, length);
    page->length += length;
    page->text[page->length] = 0;
}

static void append_markup(struct page *page, const char *text)
{
    append(page, text, strlen(text));
}

/* Length first, then the text into `out`, which is freed by the caller; NULL: no memory. */
static char *format_text(const char *format, va_list args)
{
    va_list again;
    va_copy(again, args);
    int length = vsnprintf(NULL, 0, format, again);
    va_end(again);
    char *text = length < 0 ? NULL : malloc((size_t)length + 1);
    if (text)
        vsnprintf(text, (size_t)length + 1, format, args);
    return text;
}

void page_markup(struct page *page, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    char *text = format_text(format, args);
    va_end(args);
    if (text)
        append_markup(page, text);
    page->failed = page->failed || !text;
    free(text);
}

static const char *entity_of(char c)
{
    switch (c) {
    case '&':
        return "&amp;";
    case '<':
        return "&lt;";
    case '>':
        return "&gt;";
    case '"':
        return "&quot;";
    case '\'':
        return "&#39;";
    default:
        return NULL;
    }
}

void page_text(struct page *page, const char *text)
{
    char shown[WHIT_SHOWN_BYTES];
    for (size_t length; (length = whit_text_next(text, shown)) != 0; text += length) {
        const char *entity = entity_of(*text);
        append_markup(page, entity ? entity : shown);
    }
}

/* ---- Frame ---- */

/* Colours s0 to s6 are for series of plots: by Okabe and Ito (2008), which all kinds of eyes can
   tell apart, lighter where it is dark. */
static const char style[] =
    ":root{color-scheme:light dark;--ink:#1b1b1f;--paper:#fff;--soft:#63636b;--line:#d5d5dc;"
    "--panel:#f5f5f8;--s0:#0072b2;--s1:#d55e00;--s2:#00855f;--s3:#b8478b;--s4:#a86a00;"
    "--s5:#2b8ac2;--s6:#444}\n"
    "@media (prefers-color-scheme:dark){:root{--ink:#e9e9ee;--paper:#17171b;--soft:#a3a3ad;"
    "--line:#3b3b44;--panel:#222228;--s0:#56b4e9;--s1:#ff8a4c;--s2:#2fcf9f;--s3:#ec9ecb;"
    "--s4:#e6b030;--s5:#a5d8f8;--s6:#ccc}}\n"
    "@media print{:root{color-scheme:light;--ink:#000;--paper:#fff;--soft:#444;--line:#999;"
    "--panel:#fff;--s0:#0072b2;--s1:#d55e00;--s2:#00855f;--s3:#b8478b;--s4:#a86a00;--s5:#2b8ac2;"
    "--s6:#444}}\n"
    "body{margin:0 auto;padding:1.5rem 1rem 4rem;max-width:60rem;background:var(--paper);"
    "color:var(--ink);font:16px/1.5 system-ui,sans-serif}\n"
    "h1{font-size:1.7rem;line-height:1.2;overflow-wrap:anywhere}h2{margin-top:2.5rem;font-size:1."
    "25rem}\n"
    "pre{overflow-x:auto;padding:.7rem 1rem;border-radius:.4rem;background:var(--panel);"
    "font:.875rem/1.5 ui-monospace,monospace;white-space:pre-wrap;overflow-wrap:anywhere}\n"
    ".scroll{overflow-x:auto}\n"
    "table{border-collapse:collapse;font-size:.9rem}caption{text-align:left;color:var(--soft);"
    "padding-bottom:.4rem}\n"
    "th,td{padding:.3rem .8rem .3rem 0;text-align:left;vertical-align:top;"
    "border-bottom:1px solid var(--line)}th{color:var(--soft);font-weight:600}\n"
    ".n{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}"
    "tr.mark{font-weight:700}\n"
    "figure{margin:1.2rem 0}figcaption,.legend,.names{color:var(--soft);font-size:.875rem}"
    "img{max-width:100%;height:auto;display:block;image-rendering:auto}\n"
    ".legend{display:flex;flex-wrap:wrap;gap:.2rem 1.2rem;list-style:none;padding:0;margin:.4rem 0}"
    ".legend svg{width:1.8em;height:1em;vertical-align:-.12em;margin-right:.3em}\n"
    "svg{color:var(--ink);overflow:visible}svg.plot{width:100%;height:auto;min-width:32rem;max-"
    "width:48rem;"
    "display:block;font:13px system-ui,sans-serif}"
    "svg text{fill:currentColor}.grid{stroke:var(--line);stroke-width:1}"
    ".axis{stroke:var(--soft);stroke-width:1;fill:none}.zero{stroke-dasharray:2 4}\n"
    ".tick{fill:var(--soft)}.mark .p,.mark .open{stroke:var(--ink);stroke-width:2}"
    ".p{fill:var(--c);stroke:var(--paper);stroke-width:1}.open{fill:none;stroke:var(--c);"
    "stroke-width:2.2}.l,.e{fill:none;stroke:var(--c);stroke-width:1.8}.e{stroke-width:1.2}\n"
    "g.point:hover .p{stroke:var(--ink);stroke-width:3}g.point:hover .open{stroke-width:4}\n"
    ".s0{--c:var(--s0)}.s1{--c:var(--s1)}.s2{--c:var(--s2)}.s3{--c:var(--s3)}.s4{--c:var(--s4)}"
    ".s5{--c:var(--s5)}.s6{--c:var(--s6)}\n"
    ".flip label{display:inline-block;cursor:pointer;max-width:100%}"
    ".flip input{position:absolute;opacity:0}.pair{position:relative;display:block}"
    ".pair img+img{position:absolute;top:0;left:0;visibility:hidden}"
    ".flip .nb{font-weight:400}.flip .na{font-weight:700;color:var(--ink)}\n"
    ".flip input:focus-visible+.pair{outline:3px solid var(--s0)}\n"
    "@media screen{.flip label:hover img+img,.flip input:checked+.pair img+img{visibility:visible}"
    ".flip label:hover .nb,.flip input:checked~.names .nb{font-weight:700;color:var(--ink)}"
    ".flip label:hover .na,.flip input:checked~.names .na{font-weight:400;color:inherit}}\n"
    "@media print{body{max-width:none;padding:0;font-size:11pt}.pair{display:flex;gap:2%}"
    ".pair img,.pair img+img{position:static;visibility:visible;max-width:49%}"
    ".names "
    ".how{display:none}svg.plot{min-width:0}figure,tr{break-inside:avoid}.scroll{overflow:visible}}"
    "\n";

void page_begin(struct page *page, const char *title)
{
    append_markup(page, "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" "
                        "lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
                        "<meta name=\"viewport\" content=\"width=device-width\"/>\n"
                        "<meta name=\"generator\" content=\"whit " WHIT_VERSION "\"/>\n"
                        /* A browser that is told so fetches nothing and runs nothing. */
                        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src "
                        "'none'; style-src 'unsafe-inline'; img-src data:\"/>\n<title>");
    page_text(page, title);
    append_markup(page, "</title>\n<style>\n");
    append_markup(page, style);
    append_markup(page, "</style>\n</head>\n<body>\n<h1>");
    page_text(page, title);
    append_markup(page, "</h1>\n");
}

void page_end(struct page *page)
{
    append_markup(page, "</body>\n</html>\n");
}

void page_finish(struct page *page)
{
    free(page->text);
    *page = (struct page){0};
}

whit_result page_save(const struct page *page, const char *path, const whit_log *log)
{
    if (!page->failed)
        return whit_file_write(path, page->text ? page->text : "", page->length, log);
    if (log && log->fn)
        log->fn(log->user, WHIT_LOG_ERROR, "out of memory for a page of HTML");
    return WHIT_ERROR_MEMORY;
}

/* ---- Elements ---- */

static void put_element(struct page *page, const char *name, const char *text)
{
    page_markup(page, "<%s>", name);
    page_text(page, text);
    page_markup(page, "</%s>\n", name);
}

void page_heading(struct page *page, const char *text)
{
    put_element(page, "h2", text);
}

void page_paragraph(struct page *page, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    char *text = format_text(format, args);
    va_end(args);
    if (text)
        put_element(page, "p", text);
    page->failed = page->failed || !text;
    free(text);
}

void page_code(struct page *page, const char *text)
{
    put_element(page, "pre", text);
}

static void put_cell(struct page *page, const char *name, const struct page_column *column,
                     const char *text)
{
    page_markup(page, "<%s%s>", name, column->is_number ? " class=\"n\"" : "");
    page_text(page, text);
    page_markup(page, "</%.2s>", name);
}

void page_table_begin(struct page *page, const char *caption, const struct page_column *columns,
                      uint32_t column_count)
{
    append_markup(page, "<div class=\"scroll\"><table>\n");
    if (caption)
        put_element(page, "caption", caption);
    append_markup(page, "<thead><tr>");
    for (uint32_t i = 0; i < column_count; ++i)
        put_cell(page, "th scope=\"col\"", &columns[i], columns[i].head);
    append_markup(page, "</tr></thead>\n<tbody>\n");
}

void page_table_row(struct page *page, const struct page_column *columns, uint32_t column_count,
                    const char *const *cells, bool marked)
{
    append_markup(page, marked ? "<tr class=\"mark\">" : "<tr>");
    for (uint32_t i = 0; i < column_count; ++i)
        put_cell(page, "td", &columns[i], cells[i]);
    append_markup(page, "</tr>\n");
}

void page_table_end(struct page *page)
{
    append_markup(page, "</tbody></table></div>\n");
}

/* ---- Pictures ---- */

void page_base64(struct page *page, const uint8_t *data, size_t size_bytes)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    if (!reserve(page, size_bytes / 3 * 4 + 8))
        return;
    for (size_t i = 0; i < size_bytes; i += 3) {
        size_t left = size_bytes - i;
        uint32_t bits = (uint32_t)data[i] << 16 | (left > 1 ? (uint32_t)data[i + 1] << 8 : 0) |
                        (left > 2 ? data[i + 2] : 0u);
        const char four[4] = {
            digits[bits >> 18],
            digits[bits >> 12 & 63],
            left > 1 ? digits[bits >> 6 & 63] : '=',
            left > 2 ? digits[bits & 63] : '=',
        };
        append(page, four, sizeof four);
    }
}

static void put_image(struct page *page, const whit_image *image, const char *alternative)
{
    uint8_t *data;
    size_t size_bytes;
    whit_image_info info;
    whit_image_get_info(image, &info);
    if (whit_image_encode_png(image, NULL, 0, NULL, &data, &size_bytes) != WHIT_OK) {
        page->failed = true;
        return;
    }
    page_markup(page, "<img width=\"%u\" height=\"%u\" alt=\"", info.width, info.height);
    page_text(page, alternative);
    append_markup(page, "\" src=\"data:image/png;base64,");
    page_base64(page, data, size_bytes);
    append_markup(page, "\"/>");
    whit_memory_destroy(data);
}

void page_picture(struct page *page, const whit_image *image, const char *alternative,
                  const char *caption)
{
    append_markup(page, "<figure>");
    put_image(page, image, alternative);
    if (caption)
        put_element(page, "figcaption", caption);
    append_markup(page, "</figure>\n");
}

void page_flip(struct page *page, const whit_image *a, const char *name_a, const whit_image *b,
               const char *name_b)
{
    append_markup(page, "<figure class=\"flip\"><label><input type=\"checkbox\"/>"
                        "<span class=\"pair\">");
    put_image(page, a, name_a);
    put_image(page, b, name_b);
    append_markup(page, "</span>\n<span class=\"names\"><span class=\"na\">");
    page_text(page, name_a);
    append_markup(page, "</span> | <span class=\"nb\">");
    page_text(page, name_b);
    append_markup(page, "</span> <span class=\"how\">(hover, or click to keep)</span></span>"
                        "</label></figure>\n");
}

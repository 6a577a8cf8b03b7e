/* A report as one HTML page: no script, nothing from elsewhere. It is well-formed XML too, readable
   in light and dark, printed, and by the colour-blind. */
#ifndef APP_PAGE_H
#define APP_PAGE_H

#include "whit/whit.h"

/* What was written so far. A zeroed one is empty. Memory that ran out is told by page_save. */
struct page {
    char *text; /* ended by 0, or NULL */
    size_t length, capacity;
    bool failed;
};

/* Head, style, and the title as its first heading. */
void page_begin(struct page *page, const char *title);
void page_end(struct page *page);
void page_finish(struct page *page);
/* Atomic; logs. */
WHIT_CHECK whit_result page_save(const struct page *page, const char *path, const whit_log *log);

/* Markup as it is. Numbers are in the C locale. */
void page_markup(struct page *page, const char *format, ...) WHIT_PRINTF(2, 3);
/* Text, in elements and in quoted attributes: markup in it is shown, not obeyed; else as
   whit_text_next shows it, which leaves nothing that XML has not. */
void page_text(struct page *page, const char *text);

/* Bytes as base64 (RFC 4648), for URIs of data. */
void page_base64(struct page *page, const uint8_t *data, size_t size_bytes);

void page_heading(struct page *page, const char *text); /* of a section */
void page_paragraph(struct page *page, const char *format, ...) WHIT_PRINTF(2, 3);
void page_code(struct page *page, const char *text); /* such as a command */

/* Rows between begin and end; as many cells as columns. */
struct page_column {
    const char *head;
    bool is_number; /* to the right, with figures of one width */
};
void page_table_begin(struct page *page, const char *caption, const struct page_column *columns,
                      uint32_t column_count);
/* `marked`: drawn bold, such as the best ones. */
void page_table_row(struct page *page, const struct page_column *columns, uint32_t column_count,
                    const char *const *cells, bool marked);
void page_table_end(struct page *page);

/* A picture inside the page, as a PNG in base64. `caption` may be NULL. */
void page_picture(struct page *page, const whit_image *image, const char *alternative,
                  const char *caption);
/* Two pictures of one size in one place: the second one shows while the mouse is over it, and after
   a click, or the space bar; printed they are side by side. */
void page_flip(struct page *page, const whit_image *a, const char *name_a, const whit_image *b,
               const char *name_b);

#endif

/* Reports as a single HTML file that works offline: its script draws the page from the JSON and the
   pictures embedded in it. */
#ifndef APP_PAGE_H
#define APP_PAGE_H

#include "app/document.h"
#include "whit/whit_program.h"

/* Puts a PNG into a document as a URI of data; null where `data` is NULL. */
void page_put_png(json_t *object, const char *key, const uint8_t *data, size_t size_bytes);

/* Writes `html` to a file with @REPORT@ replaced by the document. Takes over `document`. Errors
   were printed. */
WHIT_CHECK whit_result page_save(const char *html, json_t *document, const char *path);

#endif

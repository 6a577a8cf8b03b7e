/* Reports as one page that opens offline: HTML that draws itself from the JSON that is put into it,
   pictures too. */
#ifndef APP_PAGE_H
#define APP_PAGE_H

#include "app/document.h"
#include "whit/whit_program.h"

/* Puts a PNG into a document as a URI of data; null where `data` is NULL. */
void page_put_png(json_t *object, const char *key, const uint8_t *data, size_t size_bytes);

/* Writes `html` with the document in the place of its @REPORT@. Takes over `document`. Failures
   were said. */
WHIT_CHECK whit_result page_save(const char *html, json_t *document, const char *path);

#endif

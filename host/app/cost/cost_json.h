/* Reports as JSON. */
#ifndef APP_COST_COST_JSON_H
#define APP_COST_COST_JSON_H

#include "app/cost/cost.h"

/* Makes the document of a report. `cost`: its request; NULL for a kept report, which has none. */
json_t *cost_document(const struct cost_report *report, const struct cost *cost);
/* Reads a file of such a document, for comparisons: without pictures. `scene` gets the name of its
   scene, which the caller frees. False, with a message: it is no such file. */
bool cost_load_json(const char *path, struct cost_report *report, char **scene);
/* As above, for a document inside another one: takes over `root`; NULL is no report. `scene` may be
   NULL. */
bool cost_read(json_t *root, struct cost_report *report, char **scene);

#endif

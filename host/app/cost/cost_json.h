/* Reports as JSON. */
#ifndef APP_COST_COST_JSON_H
#define APP_COST_COST_JSON_H

#include "app/cost/cost.h"

json_t *cost_document(const struct cost *cost);
whit_result cost_save_json(const struct cost *cost, const char *path);
/* What cost_save_json wrote, for comparisons: no pictures. `scene` gets the name of its scene,
   which the caller frees. False, said: another file. */
bool cost_load_json(const char *path, struct cost_report *report, char **scene);
/* The same as parts of other documents. The second takes over `root`; NULL is no report. */
json_t *cost_report_document(const struct cost_report *report);
bool cost_report_read(json_t *root, struct cost_report *report);

#endif

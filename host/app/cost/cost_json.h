/* Reports as JSON. */
#ifndef APP_COST_COST_JSON_H
#define APP_COST_COST_JSON_H

#include "app/cost/cost.h"

json_t *cost_document(const struct cost *cost);
whit_result cost_save_json(const struct cost *cost, const char *path);
/* Reads a file of cost_save_json, for comparisons: without pictures. `scene` gets the name of its
   scene, which the caller frees. False, with a message: it is no such file. */
bool cost_load_json(const char *path, struct cost_report *report, char **scene);
/* As above, for a report inside another document. The second takes over `root`; NULL is no
   report. */
json_t *cost_report_document(const struct cost_report *report);
bool cost_report_read(json_t *root, struct cost_report *report);

#endif

/* The costs of a picture by kind of ray: a table on standard output, and JSON. Kinds without rays
   are left out of the table. */
#ifndef APP_RENDER_COSTS_H
#define APP_RENDER_COSTS_H

#include "whit/whit_renderer.h"

struct json_t;

void costs_print(const whit_stats *stats);
struct json_t *costs_document(const whit_stats *stats);

#endif

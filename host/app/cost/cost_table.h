/* Tables and sentences of reports, the same in all forms. */
#ifndef APP_COST_COST_TABLE_H
#define APP_COST_COST_TABLE_H

#include "app/cost/cost.h"

/* Call say() with each sentence: on how it was measured; on what the figures answer. */
typedef void cost_say(void *user, const char *sentence);
void cost_say_method(const struct cost_report *report, cost_say *say, void *user);
void cost_say_answers(const struct cost_report *report, cost_say *say, void *user);

int cost_print_text(const struct cost *cost);
/* For document_save_written; `cost` is a struct cost. */
void cost_write_markdown(FILE *to, const void *cost);
void cost_write_csv(FILE *to, const void *cost);

#endif

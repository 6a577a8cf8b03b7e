/* Tables and sentences of reports, the same in all forms. */
#ifndef APP_COST_COST_TABLE_H
#define APP_COST_COST_TABLE_H

#include "app/cost/cost.h"

/* Call say() with each sentence: on how it was measured; on what the figures answer. */
typedef void cost_say(void *user, const char *sentence);
void cost_say_method(const struct cost_report *report, cost_say *say, void *user);
void cost_say_answers(const struct cost_report *report, cost_say *say, void *user);

int cost_print_text(const struct cost *cost);
whit_result cost_save_markdown(const struct cost *cost);
whit_result cost_save_csv(const struct cost *cost);

#endif

/* Tables and sentences of reports, the same in all forms. */
#ifndef APP_COST_COST_TABLE_H
#define APP_COST_COST_TABLE_H

#include "app/cost/cost.h"

/* `is_number`: the column is right-aligned. */
struct cost_column {
    const char *head;
    bool is_number;
};
enum { COST_COLUMNS = 11, COST_HIT_COLUMNS = 13, COST_CELL = 64, COST_COLUMNS_MAX = 13 };
struct cost_cells {
    char text[COST_COLUMNS_MAX][COST_CELL];
};
extern const struct cost_column cost_columns[COST_COLUMNS], cost_hit_columns[COST_HIT_COLUMNS];
void cost_row_cells(const struct cost_report *report, const struct cost_row *row,
                    struct cost_cells *cells);
void cost_hit_cells(const struct cost_row *row, enum cost_set set, struct cost_cells *cells);
/* Call say() with each sentence: on how it was measured; on what the figures answer. */
typedef void cost_say(void *user, const char *sentence);
void cost_say_method(const struct cost_report *report, cost_say *say, void *user);
void cost_say_answers(const struct cost_report *report, cost_say *say, void *user);

int cost_print_text(const struct cost *cost);
whit_result cost_save_markdown(const struct cost *cost);
whit_result cost_save_csv(const struct cost *cost);

#endif

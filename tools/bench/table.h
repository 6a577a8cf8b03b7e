/* Tables: printed as Markdown with sentences below, kept as JSON, and drawn where rows have goals.
 */
#ifndef BENCH_TABLE_H
#define BENCH_TABLE_H

#include "bench/bench.h"

enum { TABLE_COLUMNS_MAX = 12, TABLE_ROWS_MAX = 64, TABLE_CELL = 56, TABLE_NOTES_MAX = 32 };

/* `must` 0: nothing is asked of it, and the row gets no verdict. */
struct goal {
    double must, aim;
    bool more; /* more is better */
};
struct figure {
    char name[80];
    const char *unit; /* "" for a ratio */
    double value, spread;
    struct goal goal;
};

struct table {
    struct bench *bench;
    json_t *object, *rows, *sentences, *left_out;
    bool has_goals; /* a line ends in its verdict, without a rule behind it */
    uint32_t column_count, row_count, cell;
    char cells[TABLE_ROWS_MAX][TABLE_COLUMNS_MAX][TABLE_CELL];
    char said[TABLE_NOTES_MAX][400];
    uint32_t said_count;
    struct figure figures[TABLE_ROWS_MAX]; /* that can be drawn: of which something is asked */
    uint32_t figure_count;
};

/* Heads of columns, ended by NULL; where rows have goals, table_figure fills four more. `steps`: of
   the progress. */
void table_begin(struct table *table, struct bench *bench, const char *name,
                 const char *const *heads, bool has_goals, uint32_t steps);
void table_row(struct table *table);
void table_cell(struct table *table, const char *format, ...) WHIT_PRINTF(2, 3);
void table_ms(struct table *table, const struct sample_runs *times); /* "-" of none */
/* The row as JSON, which is taken over. */
void table_keep(struct table *table, json_t *row);
/* The same with the figure of the row, and its verdict in the last cells. NAN: there is nothing to
   compare with. */
void table_figure(struct table *table, const struct figure *figure, json_t *row);
/* A row of a name, which its JSON has as `key`, and a figure. */
void table_goal(struct table *table, const char *key, const char *name, double value,
                const char *unit, struct goal goal);
/* A sentence below the table. */
void table_say(struct table *table, const char *format, ...) WHIT_PRINTF(2, 3);
/* A peer or a row that cannot be had here. */
void table_leave_out(struct table *table, const char *name, const char *why);
/* Prints it, unless it was cut short, and draws what --plot asks for: gives `result`, or what went
   wrong. */
WHIT_CHECK whit_result table_end(struct table *table, const char *title, whit_result result);

/* Gives the figure for `a` as a multiple of `b`, run by run; NAN without a goal where there are no
   such runs. */
struct figure table_ratio(const struct sample_runs *a, const struct sample_runs *b,
                          struct goal goal);
json_t *table_times(const struct sample_runs *times); /* `median spread runs` */

/* table_plot.c: how far each figure is from what it must, as SVG. */
WHIT_CHECK whit_result table_plot(const struct table *table, const char *title, const char *path);

#endif

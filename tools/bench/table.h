/* Tables: printed as Markdown with sentences below, kept as JSON, and plotted where rows have
   goals. */
#ifndef BENCH_TABLE_H
#define BENCH_TABLE_H

#include "bench/bench.h"

enum { TABLE_COLUMNS_MAX = 12, TABLE_CELL = 56 };

/* The limit that a figure must reach and the better one that it should. `must` 0: no limit, and the
   row has no verdict. */
struct goal {
    double must, aim;
    bool more; /* larger is better */
};
struct figure {
    char name[80];
    const char *unit; /* "" for a ratio */
    double value, spread;
    struct goal goal;
};

struct table_line {
    char cells[TABLE_COLUMNS_MAX][TABLE_CELL];
};

struct table {
    struct bench *bench;
    const char *title; /* set by table_end */
    json_t *object, *rows, *sentences, *left_out;
    bool has_goals; /* rows end with a verdict, without a closing `|` */
    uint32_t column_count, cell;
    struct table_line *lines; /* the head, and a line for each row */
    struct figure *figures;   /* figures with goals, for the plot */
    uint32_t line_count, line_capacity, figure_count, figure_capacity;
    bool is_short; /* memory ran out */
};

/* `heads`: heads of columns, ended by NULL; where rows have goals, table_figure fills four more
   columns. `steps`: number of progress steps. */
void table_begin(struct table *table, struct bench *bench, const char *name,
                 const char *const *heads, bool has_goals, uint32_t steps);
void table_row(struct table *table);
/* Cells and sentences go through whit_text_show, as names of files may stand in them. */
void table_cell(struct table *table, const char *format, ...) WHIT_PRINTF(2, 3);
void table_ms(struct table *table, const struct sample_runs *times); /* "-" without runs */
/* Adds the row's JSON, which is taken over. */
void table_keep(struct table *table, json_t *row);
/* As table_keep, and puts the row's figure and its verdict into the last cells. NAN: there is
   nothing to compare with. */
void table_figure(struct table *table, const struct figure *figure, json_t *row);
/* Adds a row with a name, `key` in its JSON, and a figure. */
void table_goal(struct table *table, const char *key, const char *name, double value,
                const char *unit, struct goal goal);
/* Adds a sentence below the table. */
void table_say(struct table *table, const char *format, ...) WHIT_PRINTF(2, 3);
/* Notes a peer or a row that is left out here, and why. */
void table_leave_out(struct table *table, const char *name, const char *why);
/* Prints the table unless `result` is an error, and writes the plot of --plot. Where the user has
   stopped the bench, it does so with the rows so far, if there are any. Gives `result`, or a new
   error. */
WHIT_CHECK whit_result table_end(struct table *table, const char *title, whit_result result);

/* The figure of `a` as a multiple of `b`, run by run; NAN, without a goal, where one has no
   runs. */
struct figure table_ratio(const struct sample_runs *a, const struct sample_runs *b,
                          struct goal goal);
json_t *table_times(const struct sample_runs *times); /* `median spread runs` */

/* table_plot.c: an SVG of how far each figure is from its limit. */
WHIT_CHECK whit_result table_plot(const struct table *table, const char *path);

#endif

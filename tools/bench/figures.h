/* Figures beside what they must reach: as a table, as JSON, as a drawing. */
#ifndef BENCH_FIGURES_H
#define BENCH_FIGURES_H

#include "app/bench/bench_section.h"

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

/* One table whose rows end in a verdict. */
struct figures {
    struct section section;
    struct figure list[TABLE_ROWS_MAX];
    uint32_t count;
    json_t *left_out;
};

/* `heads`: of the columns before those that figures_row adds; ended by NULL, at most 8. `steps`: of
   its progress. */
void figures_begin(struct figures *figures, struct bench *bench, const char *name,
                   const char *const *heads, uint32_t steps);
/* Ends a row whose cells are filled in; puts the figure into `row` too, and takes that over. */
void figures_row(struct figures *figures, const struct figure *figure, json_t *row);
/* A peer or a row that cannot be had here. */
void figures_leave_out(struct figures *figures, const char *name, const char *why);
/* Prints the table, unless it was cut short, and draws what --plot asks for: gives `result`, or
   what went wrong. */
WHIT_CHECK whit_result figures_end(struct figures *figures, const char *title, whit_result result);

json_t *figures_times(const struct sample_runs *times); /* `median spread runs` */

/* figures_plot.c: how far each is from what it must, as SVG. */
WHIT_CHECK whit_result figures_plot(const struct figures *figures, const char *title,
                                    const char *path);

#endif

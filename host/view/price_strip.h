/* The strip of the price list: the same crop of the picture at several costs in time. */
#ifndef VIEW_PRICE_STRIP_H
#define VIEW_PRICE_STRIP_H

#include "cost/cost.h"

struct price_strip {
    uint32_t width, height; /* size of a crop, pixels */
    struct cost_share shares[COST_STRIP];
    uint32_t *rgba[COST_STRIP]; /* NULL: there is no picture */
};

/* Makes the crops from the pictures that the report has kept. */
void price_strip_init(struct price_strip *strip, const struct cost_report *report);
void price_strip_finish(struct price_strip *strip);
/* Writes the name of a row, as "depth 0", or for a row that was chosen for the strip its title, as
   "4 x the time". */
void price_strip_name(const struct price_strip *strip, const struct cost_report *report,
                      const struct cost_row *row, char name[COST_NAME]);
void price_strip_draw(const struct price_strip *strip, const struct cost_report *report);
/* price_plot.c: draws error over time, a point for each row that the reference can judge. Rows that
   no other row beats in both are joined by a line; these and the usual row have names. */
void price_plot_draw(const struct cost_report *report, const struct price_strip *strip);

#endif

/* A plot of error over time for the rows of the price list. */
#ifndef VIEW_PRICE_PLOT_H
#define VIEW_PRICE_PLOT_H

#include "cost/cost.h"

struct price_strip;

/* Draws a point for each row that the reference can judge. Rows that no other row beats in both
   time and error are joined by a line; these and the usual row have names. */
void price_plot_draw(const struct cost_report *report, const struct price_strip *strip);

#endif

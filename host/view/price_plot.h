/* Error over time of what the price list has. */
#ifndef VIEW_PRICE_PLOT_H
#define VIEW_PRICE_PLOT_H

#include "cost/cost.h"

struct price_strip;

/* Draws a point for each row that the reference judges, joins those that nothing beats in both, and
   names these and the usual one. */
void price_plot_draw(const struct cost_report *report, const struct price_strip *strip);

#endif

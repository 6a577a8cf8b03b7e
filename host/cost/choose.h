/* The choice within a time (within.c) and that below an error (choose.c) share this: how much each
   setting changes time and error. */
#ifndef COST_CHOOSE_H
#define COST_CHOOSE_H

#include "cost/cost.h"

/* Errors whose difference is below this share count as equal. */
#define CHOOSE_AS_RIGHT 0.01

/* A setting beside the usual picture: `ratio` of their times, and the error that it adds (a square
   of RMSE, or a mean of FLIP, so that errors of several settings add up). */
struct effect {
    double ratio, error;
    bool known;
};
struct search {
    const struct cost_report *report;
    const struct cost_goal *goal;
    const struct knob *table;
    uint32_t count, aa;
    struct effect effects[COST_CHOICE_KNOBS][KNOB_SETTINGS_MAX];
    double usual_bias; /* the usual settings' error without that of samples, as a sum */
    uint8_t settings[COST_CHOICE_KNOBS];
    struct cost_choice best;
};

double choose_to_sum(double error, enum cost_metric metric);
double choose_from_sum(double sum, enum cost_metric metric);
/* Whether settings of the knob are chosen: those that change light alone. */
bool choose_is_searched(const struct search *search, uint32_t knob);

/* Marks the Pareto set by the report's clock and metric. */
void cost_mark_best(struct cost_report *report, enum cost_metric metric);

#endif

/* Shared by the choice within a time (within.c) and the choice below an error (choose.c): how much
   each setting changes time and error. */
#ifndef COST_CHOOSE_H
#define COST_CHOOSE_H

#include "cost/cost.h"

/* Errors that differ by less than this share count as equal. */
#define CHOOSE_AS_RIGHT 0.01

/* A setting compared with the usual picture: `ratio` of their times, and the `error` that it adds,
   as a squared RMSE or a mean FLIP, so that errors of several settings can be summed. */
struct effect {
    double ratio, error;
    bool known;
};
struct search {
    const struct cost_report *report;
    const struct cost_goal *goal;
    uint32_t aa;
    struct effect effects[KNOBS][KNOB_SETTINGS_MAX];
    double usual_bias; /* the usual settings' error without the sampling error: choose_to_sum */
    uint8_t settings[KNOBS];
    uint32_t samples; /* 0: as the setting of knob `aa` says */
    struct cost_choice best;
};

/* Convert an error to a value that sums over settings (squared RMSE, or FLIP), and back. */
double choose_to_sum(double error, enum cost_metric metric);
double choose_from_sum(double sum, enum cost_metric metric);
/* The sum of a picture with four times as many samples as one that has `sum`: half the sampling
   error, as for random samples, and the same bias, which is that of the usual settings. */
double choose_quadruple(const struct cost_report *report, enum cost_metric metric, double sum);

/* Whether a row with this error keeps the goal. */
bool choose_keeps(const struct cost_goal *goal, const struct cost_row *row, double error);
/* Takes a measured row in place of an answer that is not kept; for a limit of time, also in place
   of one that is kept with a larger error, if the row gives up nothing. */
void choose_measured(const struct cost_report *report, struct cost_answer *answer);

/* Sets `best` of the rows in the Pareto set of time, by the report's clock, and error. */
void cost_mark_best(struct cost_report *report, enum cost_metric metric);

#endif

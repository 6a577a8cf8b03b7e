/* Statistics of repeated measurements: summaries, and whether two measurements differ. */
#ifndef BASE_SAMPLE_H
#define BASE_SAMPLE_H

#include "whit/whit_base.h"

/* Sorts in ascending order; no value may be NAN. */
void sample_sort(double *values, uint32_t count);
/* The quantile of sorted values: `share` of them are below it; linear between neighbours. 0 when
   there are none. */
double sample_quantile(const double *sorted, uint32_t count, double share);

/* A summary of repeated runs, in the unit of their values. All 0 when there are none. */
struct sample_summary {
    double median, low, high, spread; /* low, high: quartiles; spread: half of high - low */
    double min, max;
};
struct sample_summary sample_sum_up(double *values, uint32_t count); /* sorts them */

/* The figures of one thing in the order of its runs, to be compared run by run with those of
   another thing measured in the same turns. */
enum { SAMPLE_RUNS_MAX = 99 };
struct sample_runs {
    double values[SAMPLE_RUNS_MAX];
    uint32_t count;
};
void sample_add(struct sample_runs *runs, double value); /* keeps the first SAMPLE_RUNS_MAX */
struct sample_summary sample_of(const struct sample_runs *runs);
/* The ratio a / b of each run of `a` and the run of `b` in the same turn; 0 where b is 0. */
struct sample_runs sample_ratio(const struct sample_runs *a, const struct sample_runs *b);

/* The median, and an interval that holds the true one in at least 95 of 100 such measurements,
   whatever the distribution: from the k-th value to the k-th last, where fewer than k of `count`
   tosses of a coin come up heads in at most 2.5 % of cases (David and Nagaraja, Order Statistics,
   3rd edition 2003, section 7.1). Up to 5 values are too few for that: then it goes from the least
   to the most, and `coverage`, which is exact for values drawn one by one, is below 0.95. */
struct sample_median {
    double median, low, high, coverage;
    uint32_t count;
};
/* Sorts `values`. All 0 when there are none. */
struct sample_median sample_median_of(double *values, uint32_t count);

/* Compares two things measured in turns, a[i] beside b[i]: 1 when `a` is larger, -1 when `b` is. 0
   when they cannot be distinguished: the interval of the median of a[i] - b[i] holds 0 (the sign
   test at 5 %), or there are fewer than 6 pairs. A slowdown that hits both does not count.
   `differences` has room for `count` values; *median (may be NULL) is their median. */
int sample_compare(const double *a, const double *b, uint32_t count, double *differences,
                   struct sample_median *median);
/* Compares two things that were not measured in turns, by their medians alone: 0 where the
   intervals touch or one of them covers less than 95 %. This is stricter than sample_compare. */
int sample_compare_apart(const struct sample_median *a, const struct sample_median *b);

/* Calls run(user, way, round) for each of `ways` variants in each of `rounds` rounds: from the
   first variant to the last in even rounds, and back in odd ones, so that of any two each goes
   first equally often, and a drift in time falls on all. Stops at the first failure. */
WHIT_CHECK whit_result sample_in_turns(uint32_t ways, uint32_t rounds,
                                       whit_result (*run)(void *user, uint32_t way, uint32_t round),
                                       void *user);

#endif

#include "base/sample.h"

#include <math.h>
#include <stdlib.h>

static const double COVERAGE = 0.95;

static int compare_numbers(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

void sample_sort(double *values, uint32_t count)
{
    qsort(values, count, sizeof *values, compare_numbers);
}

double sample_quantile(const double *sorted, uint32_t count, double share)
{
    if (count == 0)
        return 0.0;
    double at = share * (count - 1);
    uint32_t below = (uint32_t)at;
    uint32_t above = below + 1 < count ? below + 1 : below;
    return sorted[below] + (at - below) * (sorted[above] - sorted[below]);
}

struct sample_summary sample_sum_up(double *values, uint32_t count)
{
    sample_sort(values, count);
    double low = sample_quantile(values, count, 0.25), high = sample_quantile(values, count, 0.75);
    return (struct sample_summary){
        .median = sample_quantile(values, count, 0.5),
        .low = low,
        .high = high,
        .spread = 0.5 * (high - low),
        .min = sample_quantile(values, count, 0.0),
        .max = sample_quantile(values, count, 1.0),
    };
}

void sample_add(struct sample_runs *runs, double value)
{
    if (runs->count < SAMPLE_RUNS_MAX)
        runs->values[runs->count++] = value;
}

struct sample_summary sample_of(const struct sample_runs *runs)
{
    struct sample_runs sorted = *runs;
    return sample_sum_up(sorted.values, sorted.count);
}

struct sample_runs sample_ratio(const struct sample_runs *a, const struct sample_runs *b)
{
    struct sample_runs ratio = {0};
    for (uint32_t i = 0; i < a->count && i < b->count; ++i)
        sample_add(&ratio, b->values[i] > 0.0 ? a->values[i] / b->values[i] : 0.0);
    return ratio;
}

/* The probability that exactly `heads` of `count` tosses of a coin come up heads. */
static double chance_of(uint32_t heads, uint32_t count)
{
    double n = count, k = heads;
    return exp(lgamma(n + 1.0) - lgamma(k + 1.0) - lgamma(n - k + 1.0) - n * log(2.0));
}

/* The index of the interval's low end: the largest that keeps a coverage of at least 95 %. */
static uint32_t rank_of_low(uint32_t count, double *coverage)
{
    uint32_t rank = 0;
    double outside = 2.0 * chance_of(0, count);
    while (2 * (rank + 1) < count) {
        double more = outside + 2.0 * chance_of(rank + 1, count);
        if (more > 1.0 - COVERAGE)
            break;
        outside = more;
        ++rank;
    }
    *coverage = fmax(1.0 - outside, 0.0);
    return rank;
}

struct sample_median sample_median_of(double *values, uint32_t count)
{
    struct sample_median out = {.count = count};
    if (count == 0)
        return out;
    sample_sort(values, count);
    uint32_t rank = rank_of_low(count, &out.coverage);
    out.median = sample_quantile(values, count, 0.5);
    out.low = values[rank];
    out.high = values[count - 1 - rank];
    return out;
}

int sample_compare(const double *a, const double *b, uint32_t count, double *differences,
                   struct sample_median *median)
{
    for (uint32_t i = 0; i < count; ++i)
        differences[i] = a[i] - b[i];
    struct sample_median found = sample_median_of(differences, count);
    if (median)
        *median = found;
    if (found.coverage < COVERAGE)
        return 0;
    return found.low > 0.0 ? 1 : found.high < 0.0 ? -1 : 0;
}

int sample_compare_apart(const struct sample_median *a, const struct sample_median *b)
{
    if (a->coverage < COVERAGE || b->coverage < COVERAGE)
        return 0;
    return a->low > b->high ? 1 : a->high < b->low ? -1 : 0;
}

whit_result sample_in_turns(uint32_t ways, uint32_t rounds,
                            whit_result (*run)(void *user, uint32_t way, uint32_t round),
                            void *user)
{
    whit_result result = WHIT_OK;
    for (uint32_t round = 0; round < rounds; ++round) {
        for (uint32_t i = 0; result == WHIT_OK && i < ways; ++i)
            result = run(user, round % 2 ? ways - 1 - i : i, round);
    }
    return result;
}

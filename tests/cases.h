/* How many of a test's cases are tried. Without WHIT_TEST_TIMES (the short run) these are a quarter
   of the random cases, and some of those that take turns. With WHIT_TEST_TIMES=N, as in tests with
   the label long, all cases are tried, and random ones N times as many. */
#ifndef TESTS_CASES_H
#define TESTS_CASES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

/* The value of WHIT_TEST_TIMES; 0: not set, the short run. */
static inline uint32_t cases_times(void)
{
    const char *times = getenv("WHIT_TEST_TIMES");
    return times && atoi(times) > 0 ? (uint32_t)atoi(times) : 0;
}

static inline uint32_t cases_of(uint32_t all)
{
    uint32_t times = cases_times();
    return times ? all * times : all / 4;
}

/* How many of `all` cases are tried if each takes long: an eighth in the short run. */
static inline uint32_t cases_few(uint32_t all)
{
    return cases_times() ? cases_of(all) : all / 8;
}

/* Whether case `index` is tried if cases take turns: the short run tries one of `every` cases, and
   another one with each commit (WHIT_TEST_OFFSET). */
static inline bool cases_turn(size_t index, size_t every)
{
    const char *offset = getenv("WHIT_TEST_OFFSET");
    return cases_times() > 0 || (index + (offset ? strtoul(offset, NULL, 10) : 0)) % every == 0;
}

#endif

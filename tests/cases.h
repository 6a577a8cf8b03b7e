/* How many of a test's random cases are tried. Without WHIT_TEST_TIMES, as in the short run, a
   quarter of them; with WHIT_TEST_TIMES=N, as in tests with the label long, N times all. */
#ifndef TESTS_CASES_H
#define TESTS_CASES_H

#include <stdint.h>
#include <stdlib.h>

/* 0: the short run. */
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

#endif

/* What every unit test includes: cmocka, and checks that run because they are there. A check is a
   function of cmocka's, TEST(name) { ... } or, with what sets `*state` up before it and takes it
   down behind it, TEST_IN(name, begin, end). TEST_BY_TURNS(name, i, n) { ... } wants kernels of its
   own, which the driver takes long to compile: of n such checks the short run has one, others with
   each commit, and the entry *_long all of them. All checks of a program run in the order in which
   they stand in its file, by the main() of unit.c, or between the two functions of
   TESTS_IN(begin, end) behind them; a file that has more to do has a main() of its own, which calls
   unit_run(). */
#ifndef UNIT_H
#define UNIT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define TEST(name)                        TEST_IN(name, NULL, NULL)
#define TEST_IN(name, begin, end)         TEST_IF(true, name, begin, end)
#define TEST_BY_TURNS(name, index, every) TEST_IF(unit_turn(index, every), name, NULL, NULL)
#define TEST_IF(asked, name, begin, end)                                                           \
    static void name(void **state);                                                                \
    __attribute__((constructor)) static void add_##name(void)                                      \
    {                                                                                              \
        if (asked)                                                                                 \
            unit_add(#name, name, begin, end);                                                     \
    }                                                                                              \
    static void name(__attribute__((unused)) void **state)
#define TESTS_IN(begin, end)                                                                       \
    int main(void)                                                                                 \
    {                                                                                              \
        return unit_run(begin, end);                                                               \
    }

void unit_add(const char *name, CMUnitTestFunction check, CMFixtureFunction begin,
              CMFixtureFunction end);

/* Whether it is the turn of a check: cases_turn, or checks are asked for by name. */
bool unit_turn(size_t index, size_t every);

/* Runs all checks between `begin` and `end`, which may be NULL. How many failed. */
int unit_run(CMFixtureFunction begin, CMFixtureFunction end);

/* unit_run() then gives what `end` makes of that number, once all checks have run. */
void unit_at_end(int (*end)(int failed));

#endif

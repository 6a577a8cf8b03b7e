/* Every unit test includes this: cmocka, and macros that define a check and also add it to the list
   of those to run. TEST(name) { ... } defines a check. TEST_IN(name, begin, end) { ... } does so
   too: `begin` runs before it and sets `*state` up, `end` runs after it. TEST_BY_TURNS(name, i, n)
   { ... } is for checks that need kernels of their own, which the driver takes long to compile: the
   short run has one of n such checks, another one with each commit, and the entry *_long has all of
   them. The checks of a program run in the order of its file. The main() of unit.c runs them, or
   the one of TESTS_IN(begin, end), which stands behind them and runs `begin` before all and `end`
   after all; a file that has more to do has a main() of its own, which calls unit_run(). */
#ifndef UNIT_H
#define UNIT_H

#include <math.h>
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

/* Whether it is a check's turn, by cases_turn. Always true if WHIT_TEST_ONLY names checks. */
bool unit_turn(size_t index, size_t every);

/* Runs `begin`, all checks and `end`; both functions may be NULL. Gives the number of checks that
   failed, or the value that the function of unit_at_end returns. */
int unit_run(CMFixtureFunction begin, CMFixtureFunction end);

/* Once all checks have run, unit_run() calls `end` with the number of those that failed, and gives
   what it returns. */
void unit_at_end(int (*end)(int failed));

static inline void drop_memory(void *at)
{
    void *memory;
    memcpy(&memory, at, sizeof memory);
    free(memory);
}

/* Freed at the end of its block: own_memory char *text = ...; */
#define own_memory __attribute__((cleanup(drop_memory), unused))

#endif

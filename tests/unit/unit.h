/* What every unit test includes: cmocka, and checks that run because they are there. A check is a
   function of cmocka's, TEST(name) { ... } or, with what sets `*state` up before it and takes it
   down behind it, TEST_IN(name, begin, end). All checks of a program run in the order in which they
   stand in its file, by the main() of unit.c; a file that has more to do there has a main() of its
   own, which calls unit_run(). */
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

#define TEST(name) TEST_IN(name, NULL, NULL)
#define TEST_IN(name, begin, end)                                                                  \
    static void name(void **state);                                                                \
    __attribute__((constructor)) static void add_##name(void)                                      \
    {                                                                                              \
        unit_add(#name, name, begin, end);                                                         \
    }                                                                                              \
    static void name(__attribute__((unused)) void **state)

void unit_add(const char *name, CMUnitTestFunction check, CMFixtureFunction begin,
              CMFixtureFunction end);

/* Runs all checks between `begin` and `end`, which may be NULL. How many failed. */
int unit_run(CMFixtureFunction begin, CMFixtureFunction end);

#endif

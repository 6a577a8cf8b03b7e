/* The sequence of random numbers that all fixtures of a program share. A test that uses it sets its
   seed first. */
#ifndef TESTS_RANDOM_FIXTURE_H
#define TESTS_RANDOM_FIXTURE_H

#include "../random.h"

static uint64_t random_state;

#endif

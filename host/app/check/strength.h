/* --power and --mutate of `whit check`: which faults the pictures of a suite notice, in place of a
   check. */
#ifndef APP_CHECK_STRENGTH_H
#define APP_CHECK_STRENGTH_H

#include "app/check/check.h"

/* Draws the wanted cases, and prints which faults they notice. Gives the exit code. */
int strength_run(struct check *check);

struct fault_case;
/* power.c: prints a line with the smallest change of each kind that the case notices. */
WHIT_CHECK whit_result power_case(uint64_t *random, const struct fault_case *item);

#endif

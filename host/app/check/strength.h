/* What the pictures of a suite notice: the commands' --power and --mutate, in place of a check. */
#ifndef APP_CHECK_STRENGTH_H
#define APP_CHECK_STRENGTH_H

#include "app/check/check.h"

/* Draws the cases that are wanted, and prints what they notice. Gives the exit code. */
int strength_run(struct check *check);

struct fault_case;
/* power.c: prints a line with the smallest change of each kind that the case notices. */
WHIT_CHECK whit_result power_case(uint64_t *random, const struct fault_case *item);

#endif

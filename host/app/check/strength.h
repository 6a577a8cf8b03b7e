/* --power and --mutate of `whit check`: which faults the pictures of a suite notice, in place of a
   check. */
#ifndef APP_CHECK_STRENGTH_H
#define APP_CHECK_STRENGTH_H

#include "app/check/check.h"

/* Draws the wanted cases, and prints which faults they notice. Gives the exit code. */
int strength_run(struct check *check);

#endif

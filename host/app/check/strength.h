/* What the pictures of a suite notice: the commands' --power and --mutate, in place of a check. */
#ifndef APP_CHECK_STRENGTH_H
#define APP_CHECK_STRENGTH_H

#include "app/check/check.h"

/* Draws the cases that are wanted, and prints what they notice. Gives the exit code. */
int strength_run(struct check *check);

/* mutate.c: seeded faults, how many were caught, and of how many the cause was found. */
struct fault_case;
struct mutate_class {
    uint32_t drawn, caught, right;
};
struct mutate {
    uint64_t random;                                   /* state of the stream */
    uint32_t begun;                                    /* faults */
    struct mutate_class classes[WHIT_FAULT_KINDS + 1]; /* the last: of two faults, one is seen */
    uint32_t missing;                                  /* for which no place was found */
};
/* Puts `count` faults into the case, one after the other; says which were missed. */
WHIT_CHECK whit_result mutate_case(struct mutate *mutate, const struct fault_case *item,
                                   uint32_t count);
/* Prints the table; EXIT_DIFFERS where a fault was missed, or fewer than 95 % of causes are right.
 */
int mutate_sum_up(const struct mutate *mutate);

/* power.c: prints a line with the smallest change of each kind that the case notices. */
WHIT_CHECK whit_result power_case(uint64_t *random, const struct fault_case *item);

#endif

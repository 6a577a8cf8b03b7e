/* --mutate: puts random faults into scenes, and counts how many were caught and of how many the
   right cause was found. */
#ifndef APP_CHECK_MUTATE_H
#define APP_CHECK_MUTATE_H

#include "whit/whit_program.h"

struct fault_case;
struct mutate_class {
    uint32_t drawn, caught, right;
};
struct mutate {
    uint64_t random;                                   /* state of the random generator */
    uint32_t begun;                                    /* number of faults so far */
    struct mutate_class classes[WHIT_FAULT_KINDS + 1]; /* the last: pairs of faults, of which only
                                                          one shows */
    uint32_t missing;                                  /* faults for which no place was found */
};
/* Draws the case with `count` faults, one after the other; prints which were missed. */
WHIT_CHECK whit_result mutate_case(struct mutate *mutate, const struct fault_case *item,
                                   uint32_t count);
/* Prints the table; EXIT_DIFFERS where a fault was missed, or fewer than 95 % of causes are right.
 */
int mutate_sum_up(const struct mutate *mutate);

#endif

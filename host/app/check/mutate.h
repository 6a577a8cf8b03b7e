/* Seeded faults, how many were caught, and of how many the cause was found. */
#ifndef APP_CHECK_MUTATE_H
#define APP_CHECK_MUTATE_H

#include "whit/whit_program.h"

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

#endif

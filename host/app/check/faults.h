/* Whether a case notices faults that are put into its scene: --mutate and --power. */
#ifndef APP_CHECK_FAULTS_H
#define APP_CHECK_FAULTS_H

#include "app/check/mutate.h"
#include "app/check/trial.h"

/* A case without faults, and its picture. */
struct fault_case {
    const char *name;
    struct job input; /* of trial_draw */
    const struct drawing *was;
};

enum fault_end {
    FAULT_NONE, /* the scene has nothing that the fault could change */
    FAULT_SAME, /* the picture did not change */
    FAULT_SEEN,
};

/* Draws the scene with these faults in it. A scene that cannot be drawn counts as seen. *made: the
   scene, for the caller to destroy; may be NULL. */
WHIT_CHECK whit_result fault_draw(const struct fault_case *item, const whit_fault *faults,
                                  uint32_t count, enum fault_end *end, whit_scene **made);
/* Tries seeds from `random` until a strong fault of the kind is seen. *found: false where none of
   the tries was. */
WHIT_CHECK whit_result fault_find(const struct fault_case *item, whit_fault_kind kind,
                                  uint64_t *random, whit_fault *fault, bool *found);
/* The amount of a fault of the kind that changes the picture wherever its place is visible at
   all. */
double fault_strong(whit_fault_kind kind);

#endif

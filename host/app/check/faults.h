/* Whether a case notices faults that are put into its scene: --mutate and --power. */
#ifndef APP_CHECK_FAULTS_H
#define APP_CHECK_FAULTS_H

#include "app/check/mutate.h"
#include "app/check/trial.h"

/* A case as it is, and its picture. */
struct fault_case {
    const char *name;
    struct trial_input input;
    struct trial was;
    const whit_image *ids; /* of that picture */
};

enum fault_end {
    FAULT_NONE, /* the scene has nothing like that */
    FAULT_SAME, /* the picture is what it was */
    FAULT_SEEN,
};

/* Draws the scene with these faults in it. What cannot be drawn is seen. *made: the scene, for the
   caller to destroy; may be NULL. */
WHIT_CHECK whit_result fault_draw(const struct fault_case *item, const whit_fault *faults,
                                  uint32_t count, enum fault_end *end, whit_scene **made);
/* Draws seeds from `random` until a strong fault of the kind is seen. *found: false where one after
   the other was not. */
WHIT_CHECK whit_result fault_find(const struct fault_case *item, whit_fault_kind kind,
                                  uint64_t *random, whit_fault *fault, bool *found);
/* So strong that nobody can overlook them where their place is seen at all. */
double fault_strong(whit_fault_kind kind);

#endif

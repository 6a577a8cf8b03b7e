/* `whit check --accept` and --prune: both write the golden file of a suite. */
#ifndef APP_CHECK_ACCEPT_H
#define APP_CHECK_ACCEPT_H

#include "app/check/check.h"

/* Takes into the golden what was found of the cases that --accept names, and saves it.
   What cannot be accepted was said. Gives the exit code. */
int check_accept(struct check *check);

/* Takes out of the golden those cases that the suite has not, and saves it. Gives the
   exit code. */
int check_prune(struct check *check);

#endif

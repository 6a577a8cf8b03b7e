/* `whit check --accept` and --prune: both write the golden file of a suite. */
#ifndef APP_CHECK_ACCEPT_H
#define APP_CHECK_ACCEPT_H

#include "app/check/check.h"

/* Puts the results of the cases that --accept names into the golden, and saves it. Prints which
   cannot be accepted. Gives the exit code. */
int check_accept(struct check *check);

/* Removes from the golden the cases that the suite does not have, and saves it. Gives the exit
   code. */
int check_prune(struct check *check);

#endif

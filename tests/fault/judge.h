/* Judges a run: names the first fault in it. */
#ifndef FAULT_JUDGE_H
#define FAULT_JUDGE_H

#include "sweep.h"

/* By how it ended, with this on standard error; NULL: nothing. */
const char *judge_run(const struct sweep *sweep, int status, const char *errors);
/* By its outputs, and what it says of them; NULL: nothing. Counts what was kept.
   `fine`: it ended well. */
const char *judge_outputs(struct sweep *sweep, bool fine, const char *errors);

#endif

/* States that `whit view --replay` prints. */
#ifndef BENCH_STATES_H
#define BENCH_STATES_H

#include "bench/bench.h"

/* The member `key` of the state `name` in a file of states; a new reference, NULL: none. */
json_t *states_find(const char *path, const char *name, const char *key);

#endif

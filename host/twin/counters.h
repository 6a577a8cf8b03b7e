/* Sums of the counters of traversals. */
#ifndef TWIN_COUNTERS_H
#define TWIN_COUNTERS_H

#include "abi/bvh.h"
#include "whit/whit_renderer.h"

/* A record without rays adds nothing. */
void cost_add(whit_cost *sum, const struct gpu_cost *cost);
void cost_merge(whit_cost *sum, const whit_cost *part);

#endif

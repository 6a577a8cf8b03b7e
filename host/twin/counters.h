/* Sums of what traversals cost. */
#ifndef TWIN_COUNTERS_H
#define TWIN_COUNTERS_H

#include <stdint.h>

#include "abi/bvh.h"

/* Over records: rays of a batch, or samples of pixels that have rays of a kind. */
struct cost_sum {
    uint64_t rays, inner_nodes, leaves, instances, triangles;
    uint32_t stack, depth; /* the largest */
    uint64_t records;
    uint64_t stack_sum, depth_sum;                                      /* over records */
    uint32_t max_inner_nodes, max_leaves, max_instances, max_triangles; /* in one record */
};

/* A record without rays adds nothing. */
void cost_add(struct cost_sum *sum, const struct gpu_cost *cost);
void cost_merge(struct cost_sum *sum, const struct cost_sum *part);

#endif

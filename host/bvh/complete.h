/* Axis bits and SAH cost of finished trees. */
#ifndef BVH_COMPLETE_H
#define BVH_COMPLETE_H

#include "bvh/bvh.h"

/* Sets the axis bits of every pair of nodes, and the tree's sah_cost. Every builder ends with it.
   The same bits for any number of threads. */
void bvh_complete(struct bvh *bvh, uint32_t thread_count);
/* Sets only the axis bits of the pair of sibling nodes at `first`. */
void bvh_set_axis(struct gpu_bvh_node *first);

#endif

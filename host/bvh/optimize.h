/* Improves finished trees. */
#ifndef BVH_OPTIMIZE_H
#define BVH_OPTIMIZE_H

#include "bvh/bvh.h"

/* Improves a finished tree by moving subtrees to where they cost less: Meister and Bittner 2018,
   "Parallel reinsertion for bounding volume hierarchy optimization". Keeps leaves as they are; the
   depth stays within BVH_DEPTH_MAX. Deterministic whatever the thread count. */
WHIT_CHECK whit_result bvh_optimize(const whit_log *log, uint32_t thread_count, struct bvh *bvh);

#endif

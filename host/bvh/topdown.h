/* Top-down building. */
#ifndef BVH_TOPDOWN_H
#define BVH_TOPDOWN_H

#include "bvh/build.h"

/* Grows a tree over `count` records within `bounds`, with room for `spare` more behind them. Fills
   in out->nodes, whose leaves name runs of the builder's records, node_count and depth; allocates
   out->order for count + spare. The builder then fills in the order, and what is derived from
   nodes. */
whit_result topdown_grow(const whit_log *log, const struct builder *builder,
                         const struct build_bounds *bounds, uint32_t count, uint32_t spare,
                         struct bvh *out);

#endif

/* Top-down building. */
#ifndef BVH_TOPDOWN_H
#define BVH_TOPDOWN_H

#include "bvh/build.h"

/* Grows the tree over `count` records within `bounds`, with room for `spare` more behind them.
   Allocates out->order, for all of them, and gives out->nodes, of which leaves name runs of
   records: the order, and what follows from nodes, are the builder's to fill in. */
whit_result topdown_grow(const whit_log *log, const struct builder *builder,
                         const struct build_bounds *bounds, uint32_t count, uint32_t spare,
                         struct bvh *out);

/* Not zeroed: slots that stay empty should cost no memory. */
void *build_alloc_lines(size_t count, size_t element_bytes);

#endif

/* Records of builders. */
#ifndef BVH_RECORDS_H
#define BVH_RECORDS_H

#include "bvh/build.h"

/* Makes records in the order of the input, with -0 replaced by +0, and room for `spare` more behind
   them; free() *records. */
whit_result records_make(const whit_log *log, const struct bvh_box *boxes, uint32_t count,
                         uint32_t spare, uint32_t thread_count, struct build_record **records,
                         struct build_bounds *bounds);

/* The bounds of the first halves->count[0] records, and of the rest of `count`. */
void records_bound(const struct build_record *records, uint32_t count, struct build_halves *halves);

#endif

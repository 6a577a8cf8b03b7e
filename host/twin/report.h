/* Statistics of the mesh trees of a scene, and of the work that random lines take in them. */
#ifndef TWIN_REPORT_H
#define TWIN_REPORT_H

#include "accel/accel.h"
#include "whit/whit_accel.h"

_Static_assert((int)WHIT_DEPTH_BINS == BVH_DEPTH_MAX + 2 && (int)WHIT_LEAF_BINS == BVH_LEAF_MAX + 1,
               "a bin for each depth and one for all below, and one for each size of a leaf");

/* `ray_count` lines are measured, 0: none. Deterministic for any number of threads. */
WHIT_CHECK whit_result accel_report(const struct accel *accel, uint32_t ray_count,
                                    whit_accel_report *report);

#endif

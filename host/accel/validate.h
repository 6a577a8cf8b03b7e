/* Whether trees are sound. */
#ifndef ACCEL_VALIDATE_H
#define ACCEL_VALIDATE_H

#include "accel/accel.h"

/* Checks all trees of a scene. */
WHIT_CHECK whit_result accel_validate(const struct accel *accel);

/* Checks that every primitive is in the tree, once or in parts that cover its box, parents contain
   their children, indices are in range and paired, there is no cycle, leaves are within the limit,
   and the depth is as stated. Logs the first violation. */
WHIT_CHECK whit_result bvh_validate(const whit_log *log, const struct bvh *bvh,
                                    const struct bvh_box *boxes, uint32_t leaf_limit);

#endif

/* Whether trees are sound. */
#ifndef ACCEL_VALIDATE_H
#define ACCEL_VALIDATE_H

#include "accel/accel.h"

/* Checks a tree of valid structure: sample points all over each primitive must lie in the leaves
   that hold it, and all its records must be equal. `primitive` gives the
   primitive of the record in a slot of `triangles`. */
WHIT_CHECK whit_result accel_validate_parts(const whit_log *log, const char *name,
                                            const struct gpu_bvh_node *nodes, uint32_t node_count,
                                            const struct gpu_triangle *triangles,
                                            uint32_t primitive_count,
                                            uint32_t (*primitive)(const void *user, uint32_t slot),
                                            const void *user);

/* Checks all trees of a scene. */
WHIT_CHECK whit_result accel_validate(const struct accel *accel);

/* Checks that every primitive is in the tree, once or in parts that cover its box, parents contain
   their children, indices are in range and paired, there is no cycle, and leaf sizes and depth are
   as stated. `boxes` may be NULL when only the structure is to be checked. Logs the first
   violation. */
WHIT_CHECK whit_result bvh_validate(const whit_log *log, const struct bvh *bvh,
                                    const struct bvh_box *boxes, uint32_t leaf_limit);

#endif

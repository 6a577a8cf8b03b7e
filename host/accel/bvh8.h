/* The same trees with up to eight children a node. */
#ifndef ACCEL_BVH8_H
#define ACCEL_BVH8_H

#include "accel/accel.h"

/* Makes bvh8 of the trees that there are now, to be called again after accel_pose: mesh trees that
   did not change are kept. */
WHIT_CHECK whit_result accel_widen(struct accel *accel);
void accel_bvh8_finish(struct accel_bvh8 *bvh8);

#endif

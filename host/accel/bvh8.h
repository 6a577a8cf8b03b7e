/* Trees with up to eight children per node. */
#ifndef ACCEL_BVH8_H
#define ACCEL_BVH8_H

#include "accel/accel.h"

/* Makes accel->bvh8 from the present trees; call it again after accel_pose. Mesh trees that did not
   change are kept. WHIT_ERROR_MEMORY, logged: then it is empty. */
WHIT_CHECK whit_result accel_widen(struct accel *accel);
void accel_bvh8_finish(struct accel_bvh8 *bvh8);

#endif

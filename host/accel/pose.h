/* Instances as they stand, and the tree over them. */
#ifndef ACCEL_POSE_H
#define ACCEL_POSE_H

#include "accel/accel.h"

void accel_posing_destroy(struct accel_posing *posing);

/* Moves the instances: rewrites `instances` and the tree over them, leaves mesh trees alone. */
WHIT_CHECK whit_result accel_pose(struct accel *accel, const struct scene_pose *pose);
/* Refs that a traversal may have to keep, rounded up to a multiple of this: the size is part of
   kernels, so that scenes of other depths share them, and drivers compile those once. */
enum { ACCEL_STACK_STEP = 32 };
uint32_t accel_stack_size(const struct accel *accel);
/* The same of rays that walk together through bvh8, a multiple of 4. */
uint32_t accel_packet_stack_size(const struct accel *accel);

#endif

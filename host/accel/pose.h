/* Poses instances, and builds the tree over them. */
#ifndef ACCEL_POSE_H
#define ACCEL_POSE_H

#include "accel/accel.h"

void accel_posing_destroy(struct accel_posing *posing);

/* Sets the tree that an instance's rays enter: its root, and the centre and reach of its box. */
void accel_instance_enter(struct gpu_instance *out, const struct accel_mesh *mesh);

/* Whether the tree over instances, which must not be empty, has in node 1 the margin of its rays
   that the pose gave it. */
bool accel_has_slack(const struct accel *accel);

/* Moves the instances: rewrites `instances` and the tree over them, leaves mesh trees alone. */
WHIT_CHECK whit_result accel_pose(struct accel *accel, const struct scene_pose *pose);
/* Returns at once where the accel has the pose of that time, else does as accel_pose. Renderers of
   one accel may be at different times: each calls this before it reads what moves. */
WHIT_CHECK whit_result accel_pose_again(struct accel *accel, const struct scene_pose *pose);
/* The most refs that a traversal keeps on its stack, rounded up to a multiple of ACCEL_STACK_STEP.
   The size is a constant of kernels; rounding lets scenes of different depths share kernels, so
   that drivers compile fewer. */
enum { ACCEL_STACK_STEP = 32 };
uint32_t accel_stack_size(const struct accel *accel);
/* The stack size of ray packets in bvh8: a multiple of 4, at least 8. */
uint32_t accel_packet_stack_size(const struct accel *accel);

#endif

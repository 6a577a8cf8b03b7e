/* The boxes of trees, to be looked at. */
#ifndef ACCEL_BOXES_H
#define ACCEL_BOXES_H

#include "accel/accel.h"
#include "whit/whit_accel.h"

/* Calls fn with the nodes at `level`, and with the leaves above it, of the tree over instances or
   of the mesh trees of every instance. `pose` is the one that `accel` has. fn returns false to
   stop. Nothing where there is no such tree. */
void accel_boxes(const struct accel *accel, const struct scene_pose *pose, bool over_instances,
                 uint32_t level, bool (*fn)(void *user, const whit_box *box), void *user);

#endif

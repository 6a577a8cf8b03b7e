/* The boxes of trees, for display. */
#ifndef ACCEL_BOXES_H
#define ACCEL_BOXES_H

#include "accel/accel.h"
#include "whit/whit_accel.h"

/* Calls fn with the boxes of the nodes at `level` and of the leaves above it, in the tree over
   instances or in the mesh tree of every instance. `pose` is the one that `accel` has. fn returns
   false to stop. Where there is no such tree, nothing is called. */
void accel_boxes(const struct accel *accel, const struct scene_pose *pose, bool over_instances,
                 uint32_t level, bool (*fn)(void *user, const whit_box *box), void *user);

#endif

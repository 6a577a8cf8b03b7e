/* The boxes of trees, to be looked at. */
#ifndef ACCEL_BOXES_H
#define ACCEL_BOXES_H

#include "accel/accel.h"

/* A box of one node: parallel to the axes of its own space, not always to the world's. */
struct accel_box {
    float corners[8][3]; /* world; corner i has the upper end of axis k where bit k of i is set */
    uint32_t instance;   /* HIT_NONE: of the tree over instances, or of a tree over all of them */
    uint32_t level;      /* the root is 0 */
    bool leaf;
};

/* Calls fn with the nodes at `level`, and with the leaves above it, of the tree over instances or
   of the mesh trees of every instance. `pose` is the one that `accel` has. fn returns false to
   stop. Nothing where there is no such tree. */
void accel_boxes(const struct accel *accel, const struct scene_pose *pose, bool over_instances,
                 uint32_t level, bool (*fn)(void *user, const struct accel_box *box), void *user);

#endif

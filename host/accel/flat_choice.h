/* Decides whether a scene gets one tree in world space in place of a tree of instances. */
#ifndef ACCEL_FLAT_CHOICE_H
#define ACCEL_FLAT_CHOICE_H

#include "accel/accel.h"

/* Whether `forward` only moves spheres and scales them alike along all axes, without a turn. */
bool accel_flat_keeps_spheres(const struct affine *forward);

/* Whether WHIT_INSTANCES_OFF suits a frozen scene that is posed at `pose`: each mesh but single
   spheres has one instance, nothing moves, transforming vertices loses next to no precision, and
   there is enough memory. False for a single instance without a transform, which gains nothing. The
   answer is the same on every machine, but for memory. WHIT_ERROR_MEMORY, logged. */
WHIT_CHECK whit_result accel_flat_suits(const struct scene *scene, const struct scene_pose *pose,
                                        bool *out);

#endif

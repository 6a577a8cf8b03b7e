/* Decides whether a scene gets one tree in world space in place of a tree of instances. */
#ifndef ACCEL_FLAT_CHOICE_H
#define ACCEL_FLAT_CHOICE_H

#include "accel/accel.h"

/* Whether `forward` leaves spheres spheres, and does not turn them. */
bool accel_flat_keeps_spheres(const struct affine *forward);

/* Whether `flatten` suits a frozen scene, which stands at `pose`: no mesh but a single ball is
   there twice, nothing moves, vertices are rounded by next to nothing when they are placed, and
   memory is enough. It is no news for one instance that is where its mesh is. The same on every
   machine, but for memory. WHIT_ERROR_MEMORY, logged. */
WHIT_CHECK whit_result accel_flat_suits(const struct scene *scene, const struct scene_pose *pose,
                                        bool *out);

#endif

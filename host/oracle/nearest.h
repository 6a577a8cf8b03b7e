/* The distance from a point to a scene, in double. */
#ifndef ORACLE_NEAREST_H
#define ORACLE_NEAREST_H

#include "accel/accel.h"

/* From a point to the nearest surface, world units, in double; to spheres that a transform
   stretches it may be less. Infinity in an empty scene. `pose` is the one that `accel` has. */
double accel_distance(const struct accel *accel, const struct scene_pose *pose, const double p[3]);

#endif

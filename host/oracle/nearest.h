/* The distance from a point to a scene, in double. */
#ifndef ORACLE_NEAREST_H
#define ORACLE_NEAREST_H

#include "accel/accel.h"

/* The distance from a point to the nearest surface, in world units and double; a lower bound for
   spheres that a transform stretches. Infinity in an empty scene. `pose` is the one that `accel`
   has. */
double accel_distance(const struct accel *accel, const struct scene_pose *pose, const double p[3]);

#endif

/* The distance from a point to a scene, in double. */
#ifndef ORACLE_NEAREST_H
#define ORACLE_NEAREST_H

#include "accel/accel.h"

/* The distance from a point to the nearest surface, in world units and double; a lower bound for
   spheres that a transform stretches. Infinity in an empty scene. `pose` is the one that `accel`
   has. */
double accel_distance(const struct accel *accel, const struct scene_pose *pose, const double p[3]);
/* By which share of its length a shadow ray to a point or spot light ends before it. 0, but for a
   light that lies in a surface, as a lamp in a ceiling: that surface casts no shadow, where
   roundings would decide at each point whether it does. 0 for other kinds of lights. */
float accel_light_end_share(const struct accel *accel, const struct scene_pose *pose,
                            const struct scene_light *light);

#endif

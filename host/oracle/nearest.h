/* The distance from a point to a scene, in double. */
#ifndef ORACLE_NEAREST_H
#define ORACLE_NEAREST_H

#include "accel/accel.h"

/* The distance from a point to the nearest surface, in world units and double; a lower bound for
   spheres that a transform stretches. Infinity in an empty scene. `pose` is the one that `accel`
   has. */
double accel_distance(const struct accel *accel, const struct scene_pose *pose, const double p[3]);
/* Gives how far before a light its shadow rays end, so that a surface in which the light lies, as a
   lamp in a ceiling, casts no shadow; else roundings would decide at each point whether it does.
   For a point or spot light: a share of the ray's length, 0 if the light is in no surface. For an
   emitter: how far surfaces in its plane may be off it, in world units. 0 for directional lights.
 */
float accel_light_end(const struct accel *accel, const struct scene_pose *pose,
                      const struct scene_light *light);

#endif

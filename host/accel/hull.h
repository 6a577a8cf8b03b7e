/* Whether a mesh is its own convex hull. */
#ifndef ACCEL_HULL_H
#define ACCEL_HULL_H

#include "scene/scene.h"

/* HULL_* of abi/bvh.h. HULL_NONE also where the mesh has too many vertices to tell. */
uint32_t accel_hull(const struct scene_mesh *mesh);

#endif

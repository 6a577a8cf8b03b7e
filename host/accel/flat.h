/* One tree over everything: accel->world. */
#ifndef ACCEL_FLAT_H
#define ACCEL_FLAT_H

#include "accel/accel.h"

enum { FLAT_TRIANGLE_BYTES = 300 }; /* at the peak of a build: vertices, boxes, builder, records */
#define FLAT_TRIANGLES_MAX  (BVH_FIRST_MASK / 2)
#define FLAT_VERTICES_MAX   (UINT32_MAX / 4)
#define FLAT_INSTANCES_MAX  (UINT32_MAX >> TRIANGLE_INSTANCE_SHIFT)
#define FLAT_COORDINATE_MAX 1e18 /* scene_freeze has it in object space */

/* How many points of the mesh are transformed: its vertices, or the centres of its spheres. */
static inline uint32_t accel_flat_vertices(const struct scene_mesh *mesh)
{
    return mesh->sphere_count ? mesh->sphere_count : mesh->vertex_count;
}

/* Prepares one tree over all triangles instead of mesh trees; it is built with the first pose. */
WHIT_CHECK whit_result accel_flat_create(struct accel *accel);
/* Builds the world tree for `pose` as accel->meshes[0]; keeps the present tree where no instance
   has moved. Changes nothing on failure. */
WHIT_CHECK whit_result accel_flat_build(struct accel *accel, const struct scene_pose *pose);
void accel_flat_destroy(struct accel_flat *flat);
/* The meshes of the scene; only triangle_count and shade_base are set. */
const struct accel_mesh *accel_flat_meshes(const struct accel_flat *flat);
/* Index of an instance's primitive 0 among the primitives of all instances, whose number is that of
   the instance behind the last one. */
uint32_t accel_flat_first(const struct accel_flat *flat, uint32_t instance);

#endif

/* Shared by the files of accel/ alone. */
#ifndef ACCEL_ACCEL_INSIDE_H
#define ACCEL_ACCEL_INSIDE_H

#include "accel/extent.h"

/* ---- material_bits.c ---- */

/* What a material means to traversal. */
struct material_bits {
    uint32_t flags, shadow;
    bool masked;    /* SCENE_ALPHA_MASK: colours of vertices may cut it out */
    bool patterned; /* a filter that textures or vertex colours have a say in */
};

/* One for each material of the scene. */
void material_bits_scan(const struct scene *scene, struct material_bits *out);
/* Filters add to a shadow ray's depth each time they are met: they are met once. 1 a triangle. */
void material_bits_whole(const struct scene *scene, const struct material_bits *materials,
                         const struct scene_mesh *mesh, uint8_t *whole);
struct gpu_triangle material_bits_record(const struct scene *scene,
                                         const struct material_bits *materials,
                                         const struct scene_mesh *mesh, uint32_t primitive);

/* ---- flat.c: accel->world ---- */

enum { FLAT_TRIANGLE_BYTES = 300 }; /* at the peak of a build: corners, boxes, builder, records */
#define FLAT_TRIANGLES_MAX  (BVH_FIRST_MASK / 2)
#define FLAT_VERTICES_MAX   (UINT32_MAX / 4)
#define FLAT_INSTANCES_MAX  (UINT32_MAX >> TRIANGLE_INSTANCE_SHIFT)
#define FLAT_COORDINATE_MAX 1e18 /* as scene_freeze has it in object space */

/* The centre stands for a sphere's vertices. */
static inline uint32_t accel_flat_vertices(const struct scene_mesh *mesh)
{
    return mesh->sphere_count ? mesh->sphere_count : mesh->vertex_count;
}

/* Whether spheres under it are spheres that are not turned (flat_choice.c). */
bool accel_flat_keeps_spheres(const struct affine *forward);

/* Prepares one tree over all triangles instead of mesh trees; it is built with the first pose. */
WHIT_CHECK whit_result accel_flat_create(struct accel *accel);
/* Builds that tree for `pose` as accel->meshes[0]; keeps the present one where no instance has
   moved. Changes nothing on failure. */
WHIT_CHECK whit_result accel_flat_build(struct accel *accel, const struct scene_pose *pose);
void accel_flat_destroy(struct accel_flat *flat);
/* The meshes of the scene; only triangle_count and shade_base are set. */
const struct accel_mesh *accel_flat_meshes(const struct accel_flat *flat);
/* Number of an instance's primitive 0 among all triangles. */
uint32_t accel_flat_first(const struct accel_flat *flat, uint32_t instance);

/* pose.c */
void accel_posing_destroy(struct accel_posing *posing);

/* Checks a tree of valid structure: sample points all over each primitive must lie in the leaves
   that hold it, and all its records must be equal (bvh_validate_parts.c). `primitive` gives the
   primitive of the record in a slot of `triangles`. */
WHIT_CHECK whit_result accel_validate_parts(const whit_log *log, const char *name,
                                            const struct gpu_bvh_node *nodes, uint32_t node_count,
                                            const struct gpu_triangle *triangles,
                                            uint32_t primitive_count,
                                            uint32_t (*primitive)(const void *user, uint32_t slot),
                                            const void *user);

#endif

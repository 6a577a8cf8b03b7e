/* Materials as the records of a tree say them. */
#ifndef ACCEL_MATERIAL_BITS_H
#define ACCEL_MATERIAL_BITS_H

#include "accel/accel.h"

/* The bits that a material sets in the records of its primitives, for traversal. */
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

/* Whether any record has TRIANGLE_FILTER_DETAIL. */
bool accel_filters_vary(const struct accel *accel);
/* Whether textures or vertex colours have a say in any of them; else these absorb, and that is all.
 */
bool accel_filters_patterned(const struct accel *accel);
/* TRIANGLE_* that the records of a primitive have, but those of its place in a tree. */
uint32_t accel_primitive_flags(const struct accel *accel, uint32_t instance, uint32_t primitive);

#endif

/* The bits in the records of a tree that hold properties of materials. */
#ifndef ACCEL_MATERIAL_BITS_H
#define ACCEL_MATERIAL_BITS_H

#include "accel/accel.h"

/* Properties of a material: `flags` and `shadow` stand in the records of its primitives, for
   traversal, and the others decide which flags those get. */
struct material_bits {
    uint32_t flags, shadow;
    bool masked;    /* SCENE_ALPHA_MASK: vertex colours may cut parts out */
    bool patterned; /* a shadow filter that depends on textures or vertex colours */
};

/* One for each material of the scene. */
void material_bits_scan(const struct scene *scene, struct material_bits *out);
/* Sets whole[i] to 1 for each triangle i that must stay in one leaf, else to 0: filters, whose
   optical depth is added each time a shadow ray hits one of their records. */
void material_bits_whole(const struct material_bits *materials, const struct scene_mesh *mesh,
                         uint8_t *whole);
struct gpu_triangle material_bits_record(const struct material_bits *materials,
                                         const struct scene_mesh *mesh, uint32_t primitive);

/* Whether any record has TRIANGLE_FILTER_DETAIL. */
bool accel_filters_vary(const struct accel *accel);
/* Whether any filter depends on textures or vertex colours. If not, TRIANGLE_FILTER_DETAIL stands
   for absorption alone. */
bool accel_filters_patterned(const struct accel *accel);
/* The TRIANGLE_* flags of a primitive's records, without those that depend on the record's place in
   a tree. */
uint32_t accel_primitive_flags(const struct accel *accel, uint32_t instance, uint32_t primitive);

#endif

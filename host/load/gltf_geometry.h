/* Meshes of a glTF. */
#ifndef LOAD_GLTF_GEOMETRY_H
#define LOAD_GLTF_GEOMETRY_H

#include "load/gltf_accessor.h"
#include "load/gltf_json.h"

struct gltf_primitive {
    struct gltf_place at;
    uint32_t mode, material, vertex_count, corner_count;
    /* By enum part_array; a count of 0: absent. */
    struct gltf_accessor accessors[PART_ARRAY_COUNT];
    const json_t *attributes;
    const json_t *draco; /* the extension, or NULL */
};

struct gltf_attribute {
    const char *name, *type;
    uint32_t least; /* fewest components that an accessor may have */
};
extern const struct gltf_attribute gltf_attributes[PART_INDICES];

whit_result gltf_load_meshes(struct gltf *gltf);

#endif

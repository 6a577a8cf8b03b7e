/* Draco compression of glTF primitives. */
#ifndef LOAD_GLTF_DRACO_H
#define LOAD_GLTF_DRACO_H

#include "load/gltf_geometry.h"

/* Whether the array is in the primitive's Draco data, and not in its accessor's view. */
bool gltf_is_packed(const struct gltf_primitive *primitive, enum part_array array);
/* Decodes the primitive's Draco data: adds its indices and compressed arrays to `part`. */
whit_result gltf_unpack(const struct gltf *gltf, const struct gltf_primitive *primitive,
                        struct part *part);

#endif

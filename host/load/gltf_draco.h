/* What Draco has packed. */
#ifndef LOAD_GLTF_DRACO_H
#define LOAD_GLTF_DRACO_H

#include "load/gltf_geometry.h"

/* Whether the array comes from Draco, and not from its accessor. */
bool gltf_is_packed(const struct gltf_primitive *primitive, enum import_array array);
/* Fills `part` with the arrays that Draco has packed, and the indices. */
whit_result gltf_unpack(const struct gltf *gltf, const struct gltf_primitive *primitive,
                        struct part *part);

#endif

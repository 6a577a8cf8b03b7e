/* Makes meshes from the parts of models. */
#ifndef LOAD_MODEL_MESH_H
#define LOAD_MODEL_MESH_H

#include "load/importer.h"
#include "load/load.h"

/* Adds one mesh of all parts, with a group for each; v is turned downwards. An array that only some
   parts have gets default values for the others; tangents are dropped unless all parts have them.
   `materials`: of the scene, by part. A part without a name has the mesh's. `colors_are_srgb`:
   colours are converted to linear. *index: the new mesh. */
WHIT_CHECK whit_result model_add_mesh(struct scene *scene, const char *name,
                                      const struct part *parts, const uint32_t *materials,
                                      uint32_t part_count, bool colors_are_srgb, uint32_t *index);

#endif

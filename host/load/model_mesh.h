/* Meshes of the parts of models. */
#ifndef LOAD_MODEL_MESH_H
#define LOAD_MODEL_MESH_H

#include "load/importer.h"
#include "load/load.h"

struct model_part {
    const struct import_part *part;
    const char *name;
    uint32_t material; /* of the scene */
};

/* One mesh out of all parts, each a group of it, v turned downwards. An array that only some parts
   have is filled with what its absence means; tangents are kept only where all parts have them.
   `colors_are_srgb`: they are made linear. *index is the new mesh. */
WHIT_CHECK whit_result model_add_mesh(struct scene *scene, const char *name,
                                      const struct model_part *parts, uint32_t part_count,
                                      bool colors_are_srgb, uint32_t *index);

/* Notes what the importer left out. */
void model_note_counts(struct scene *scene, const char *path, const struct import_counts *counts);

#endif

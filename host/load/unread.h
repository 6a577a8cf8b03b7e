/* Finds statements of COLLADA and FBX files that assimp 5.2 leaves out without a word. */
#ifndef LOAD_UNREAD_H
#define LOAD_UNREAD_H

#include "load/importer.h"

/* Searches the model's bytes, and sets of *counts:
   wraps: wrap modes of textures other than repetition;
   uv_sets: bindings of textures to other texture coordinates than the first;
   parameters: values of effects that name a parameter;
   hidden: models that are not visible;
   bind_shapes: matrices of skins that move their meshes.
   Values are not searched for in other formats. */
void unread_count(const struct import_request *request, struct import_counts *counts);

/* Why assimp would crash on a COLLADA, or NULL. */
const char *unread_refusal(const struct import_file *file);

/* Whether the sets of texture coordinates that assimp gives for a COLLADA are those of the file. */
bool unread_trusts_sets(const struct import_file *file);

#endif

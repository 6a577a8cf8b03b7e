/* Hashes over all of a scene that pictures depend on. */
#ifndef SCENE_HASH_H
#define SCENE_HASH_H

#include "scene/freeze.h"
#include "whit/whit_program.h"

uint64_t freeze_hash(const struct scene *scene);
/* The same of one record; `kind` says what it is: a struct scene_mesh, scene_material and so on.
   WHIT_PART_OBJECTS has no record. */
uint64_t freeze_hash_record(enum whit_part_kind kind, const void *record);
/* Hashes the scene's nodes and instances. */
uint64_t freeze_hash_objects(const struct scene *scene);

#endif

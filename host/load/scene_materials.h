/* Materials of a scene file. */
#ifndef LOAD_SCENE_MATERIALS_H
#define LOAD_SCENE_MATERIALS_H

#include "load/scene_reader.h"

bool reader_materials(struct reader *reader, const struct place *place, const json_t *value);
/* Reads the index of the object's "material"; *index is SCENE_NONE when it names none. */
bool reader_object_material(struct reader *reader, const struct place *place, const json_t *object,
                            uint32_t *index);

#endif

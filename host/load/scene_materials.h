/* Materials of a scene file. */
#ifndef LOAD_SCENE_MATERIALS_H
#define LOAD_SCENE_MATERIALS_H

#include "load/scene_reader.h"

bool reader_materials(struct reader *reader, const struct place *place, const json_t *value);
/* A material's name or a material written in place. */
bool reader_material_use(struct reader *reader, const struct place *place, const json_t *value,
                         uint32_t *index);
/* Reads the index of the object's "material"; *index is SCENE_NONE when it names none. */
bool reader_object_material(struct reader *reader, const struct place *place, const json_t *object,
                            uint32_t *index);

#endif

/* Those fields of scene records that are plain values: no names, and no indices of other records.
   Each table ends with a field whose name is NULL. */
#ifndef SCENE_FIELDS_H
#define SCENE_FIELDS_H

#include "scene/scene.h"

enum scene_field_form {
    SCENE_FLOATS,
    SCENE_DOUBLES,
    SCENE_WORDS, /* integers: int32_t */
    SCENE_FLAG,  /* bool */
    SCENE_NAMED, /* an enumeration, whose values are called `names` */
};
struct scene_field {
    const char *name; /* in messages */
    size_t offset;    /* in the record */
    enum scene_field_form form;
    uint32_t count; /* of values side by side */
    const char *const *names;
};
extern const struct scene_field scene_material_fields[], scene_texture_use_fields[],
    scene_light_fields[], scene_camera_fields[], scene_channel_fields[], scene_environment_fields[],
    scene_own_fields[]; /* the last: of the scene itself */

#endif

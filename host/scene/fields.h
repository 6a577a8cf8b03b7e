/* The fields of records that are plain values, without names of records and indices of others. Each
   table ends with a field without a name. */
#ifndef SCENE_FIELDS_H
#define SCENE_FIELDS_H

#include "scene/scene.h"

enum scene_field_form {
    SCENE_FLOATS,
    SCENE_DOUBLES,
    SCENE_WORDS, /* int32_t */
    SCENE_FLAG,  /* bool */
    SCENE_NAMED, /* an enumeration, whose words are `names` */
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

/* Tables of plain values in records: change.c describes differences by them, and scene_parts_test
   checks that hash.c hashes every field in them. */
#include "scene/fields.h"

#define FIELD(type, form, field, count, name)                                                      \
    {                                                                                              \
        name, offsetof(type, field), form, count, NULL                                             \
    }
#define FIELD_OF_NAMES(type, field, names, name)                                                   \
    {                                                                                              \
        name, offsetof(type, field), SCENE_NAMED, 1, names                                         \
    }

#define MATERIAL(form, field, count, name) FIELD(struct scene_material, form, field, count, name)
const struct scene_field scene_material_fields[] = {
    FIELD_OF_NAMES(struct scene_material, model, scene_model_names, "model"),
    MATERIAL(SCENE_WORDS, illum, 1, "illum"),
    MATERIAL(SCENE_FLOATS, diffuse, 3, "diffuse"),
    MATERIAL(SCENE_FLOATS, ambient, 3, "ambient"),
    MATERIAL(SCENE_FLOATS, specular, 3, "specular"),
    MATERIAL(SCENE_FLOATS, shininess, 1, "shininess"),
    MATERIAL(SCENE_FLOATS, emission, 3, "emission"),
    MATERIAL(SCENE_FLOATS, reflection, 3, "reflection"),
    MATERIAL(SCENE_FLOATS, transmission, 3, "transmission"),
    MATERIAL(SCENE_FLOATS, absorption, 3, "absorption"),
    MATERIAL(SCENE_FLOATS, ior, 1, "ior"),
    MATERIAL(SCENE_FLAG, fresnel, 1, "fresnel"),
    MATERIAL(SCENE_FLAG, thin_walled, 1, "thin walled"),
    MATERIAL(SCENE_FLAG, two_sided, 1, "two-sided"),
    MATERIAL(SCENE_FLAG, one_sided, 1, "one-sided"),
    MATERIAL(SCENE_FLAG, shadow_catcher, 1, "shadow catcher"),
    MATERIAL(SCENE_WORDS, priority, 1, "priority"),
    MATERIAL(SCENE_FLOATS, metallic, 1, "metallic"),
    MATERIAL(SCENE_FLOATS, roughness, 1, "roughness"),
    MATERIAL(SCENE_FLOATS, specular_level, 1, "specular level"),
    FIELD_OF_NAMES(struct scene_material, alpha, scene_alpha_names, "alpha mode"),
    MATERIAL(SCENE_FLOATS, opacity, 1, "opacity"),
    MATERIAL(SCENE_FLOATS, alpha_cutoff, 1, "alpha cut-off"),
    MATERIAL(SCENE_FLOATS, normal_scale, 1, "scale of normals"),
    {0},
};

const struct scene_field scene_texture_use_fields[] = {
    FIELD(struct scene_texture_use, SCENE_WORDS, uv_set, 1, "set of texture coordinates"),
    FIELD(struct scene_texture_use, SCENE_FLOATS, transform, 6, "transform of texture coordinates"),
    FIELD_OF_NAMES(struct scene_texture_use, wrap_u, scene_wrap_names, "wrap of u"),
    FIELD_OF_NAMES(struct scene_texture_use, wrap_v, scene_wrap_names, "wrap of v"),
    FIELD(struct scene_texture_use, SCENE_FLAG, nearest, 1, "nearest texel"),
    {0},
};

#define LIGHT(form, field, count, name) FIELD(struct scene_light, form, field, count, name)
const struct scene_field scene_light_fields[] = {
    FIELD_OF_NAMES(struct scene_light, kind, scene_light_kind_names, "kind"),
    LIGHT(SCENE_DOUBLES, position, 3, "position"),
    LIGHT(SCENE_DOUBLES, direction, 3, "direction"),
    LIGHT(SCENE_FLOATS, stated, 3, "colour"),
    LIGHT(SCENE_FLAG, falloff, 1, "falloff"),
    LIGHT(SCENE_FLOATS, range, 1, "range"),
    LIGHT(SCENE_FLOATS, versine_inner, 1, "1 - cosine of the inner angle"),
    LIGHT(SCENE_FLOATS, versine_outer, 1, "1 - cosine of the outer angle"),
    LIGHT(SCENE_DOUBLES, edge_u, 3, "first edge"),
    LIGHT(SCENE_DOUBLES, edge_v, 3, "second edge"),
    LIGHT(SCENE_FLAG, two_sided, 1, "two-sided"),
    {0},
};

#define CAMERA(form, field, count, name) FIELD(struct scene_camera, form, field, count, name)
const struct scene_field scene_camera_fields[] = {
    FIELD_OF_NAMES(struct scene_camera, kind, scene_camera_kind_names, "kind"),
    CAMERA(SCENE_DOUBLES, eye, 3, "eye"),
    CAMERA(SCENE_DOUBLES, target, 3, "target"),
    CAMERA(SCENE_DOUBLES, up, 3, "up"),
    CAMERA(SCENE_FLOATS, fov_y, 1, "vertical angle"),
    CAMERA(SCENE_FLOATS, height, 1, "height"),
    CAMERA(SCENE_FLOATS, lens_radius, 1, "radius of the lens"),
    CAMERA(SCENE_FLOATS, focus_distance, 1, "focus distance"),
    CAMERA(SCENE_FLOATS, aspect, 1, "aspect"),
    {0},
};

const struct scene_field scene_channel_fields[] = {
    FIELD_OF_NAMES(struct scene_channel, interpolation, scene_interpolation_names, "interpolation"),
    {0},
};

#define SKY(form, field, count, name) FIELD(struct scene_environment, form, field, count, name)
const struct scene_field scene_environment_fields[] = {
    FIELD_OF_NAMES(struct scene_environment, kind, scene_environment_kind_names, "kind"),
    SKY(SCENE_FLOATS, zenith, 3, "zenith"),
    SKY(SCENE_FLOATS, horizon, 3, "horizon"),
    SKY(SCENE_FLOATS, ground, 3, "ground"),
    SKY(SCENE_FLOATS, scale, 3, "scale"),
    SKY(SCENE_WORDS, width, 1, "width of the map"),
    SKY(SCENE_WORDS, height, 1, "height of the map"),
    {0},
};

const struct scene_field scene_own_fields[] = {
    FIELD(struct scene, SCENE_FLAG, has_environment, 1, "environment of the file"),
    FIELD(struct scene, SCENE_FLAG, has_ambient, 1, "ambient light of the file"),
    FIELD(struct scene, SCENE_FLOATS, ambient, 3, "ambient light"),
    FIELD(struct scene, SCENE_FLOATS, contact, 1, "contact"),
    {0},
};

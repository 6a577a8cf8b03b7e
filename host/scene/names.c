/* Names of the scene's enumerators, as reports, messages and scene files use them. */
#include "scene/scene.h"

const char *const scene_model_names[] = {
    [WHIT_MODEL_PHONG] = "phong",
    [WHIT_MODEL_METAL_ROUGH] = "metal-rough",
    [WHIT_MODEL_UNLIT] = "unlit",
};

const char *const scene_alpha_names[] = {
    [SCENE_ALPHA_OPAQUE] = "opaque",
    [SCENE_ALPHA_MASK] = "mask",
    [SCENE_ALPHA_BLEND] = "blend",
    NULL,
};

const char *const scene_wrap_names[] = {
    [SCENE_WRAP_REPEAT] = "repeat",
    [SCENE_WRAP_CLAMP] = "clamp",
    [SCENE_WRAP_MIRROR] = "mirror",
    NULL,
};

const char *const scene_interpolation_names[] = {
    [SCENE_STEP] = "step",
    [SCENE_LINEAR] = "linear",
    [SCENE_CUBIC] = "cubic",
    NULL,
};

const char *const scene_light_kind_names[WHIT_LIGHT_KINDS] = {
    [WHIT_LIGHT_POINT] = "point",         [WHIT_LIGHT_DIRECTIONAL] = "directional",
    [WHIT_LIGHT_SPOT] = "spot",           [WHIT_LIGHT_AREA_SAMPLE] = "area-sample",
    [WHIT_LIGHT_RECTANGLE] = "rectangle", [WHIT_LIGHT_TRIANGLE] = "triangle",
};

const char *const scene_camera_kind_names[] = {
    [WHIT_CAMERA_PERSPECTIVE] = "perspective",
    [WHIT_CAMERA_ORTHOGRAPHIC] = "orthographic",
    [WHIT_CAMERA_PANORAMA] = "panorama",
};

const char *const scene_environment_kind_names[] = {
    [WHIT_ENVIRONMENT_GRADIENT] = "gradient",
    [WHIT_ENVIRONMENT_MAP] = "map",
};

#define NAME_OF(names, value)                                                                      \
    ((size_t)(value) < sizeof(names) / sizeof *(names) ? (names)[value] : "")

const char *whit_material_model_name(whit_material_model model)
{
    return NAME_OF(scene_model_names, model);
}

const char *whit_light_kind_name(whit_light_kind kind)
{
    return NAME_OF(scene_light_kind_names, kind);
}

const char *whit_camera_kind_name(whit_camera_kind kind)
{
    return NAME_OF(scene_camera_kind_names, kind);
}

const char *whit_environment_kind_name(whit_environment_kind kind)
{
    return NAME_OF(scene_environment_kind_names, kind);
}

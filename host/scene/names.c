/* The words of the scene's enumerations, in receipts, messages and scene files. */
#include "scene/scene.h"

const char *const scene_model_names[] = {
    [SCENE_MODEL_PHONG] = "phong",
    [SCENE_MODEL_METAL_ROUGH] = "metal-rough",
    [SCENE_MODEL_UNLIT] = "unlit",
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

const char *const scene_light_kind_names[SCENE_LIGHT_KINDS] = {
    [SCENE_LIGHT_POINT] = "point",         [SCENE_LIGHT_DIRECTIONAL] = "directional",
    [SCENE_LIGHT_SPOT] = "spot",           [SCENE_LIGHT_AREA_SAMPLE] = "area-sample",
    [SCENE_LIGHT_RECTANGLE] = "rectangle", [SCENE_LIGHT_TRIANGLE] = "triangle",
};

const char *const scene_camera_kind_names[] = {
    [SCENE_CAMERA_PERSPECTIVE] = "perspective",
    [SCENE_CAMERA_ORTHOGRAPHIC] = "orthographic",
    [SCENE_CAMERA_PANORAMA] = "panorama",
};

const char *const scene_environment_kind_names[] = {
    [SCENE_ENVIRONMENT_GRADIENT] = "gradient",
    [SCENE_ENVIRONMENT_MAP] = "map",
};

/* From the parts of an imported block to meshes of the scene, and the formats' entry points. */
#ifndef LOAD_MODEL_H
#define LOAD_MODEL_H

#include "load/importer.h"
#include "load/load.h"

/* How a model is added: see load_model. */
struct model_request {
    const char *path;
    uint32_t parent;
    bool with_lights, with_cameras;
    const whit_load_params *params;
};

/* Whether the path's extension is one of LOAD_MODELS. */
bool load_is_model(const char *path);

/* The parts of load_scene, for scene files that place models: adds what the model holds to an
   unfrozen scene, its nodes below `parent` (SCENE_NONE: roots). Cameras, lights and environment of
   the model are added only when `with_lights` / `with_cameras`. */
WHIT_CHECK whit_result load_model(struct scene *scene, const char *path, uint32_t parent,
                                  bool with_lights, bool with_cameras,
                                  const whit_load_params *params);

#endif

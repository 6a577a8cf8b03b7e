/* Adds models of all formats to a scene. */
#ifndef LOAD_MODEL_H
#define LOAD_MODEL_H

#include "load/importer.h"
#include "load/load.h"

/* A request to add a model: see load_model. */
struct model_request {
    const char *path;
    uint32_t parent;
    bool with_lights, with_cameras;
    const whit_load_params *params;
};

/* Whether the path's extension is one of LOAD_MODELS. */
bool load_is_model(const char *path);

/* Adds a model to an unfrozen scene, with its nodes below `parent` (SCENE_NONE: as roots). The
   model's lights and environment are added only if `with_lights`, its cameras if `with_cameras`. */
WHIT_CHECK whit_result load_model(struct scene *scene, const char *path, uint32_t parent,
                                  bool with_lights, bool with_cameras,
                                  const whit_load_params *params);

#endif

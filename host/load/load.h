/* Files into scenes. */
#ifndef LOAD_LOAD_H
#define LOAD_LOAD_H

#include <stddef.h>

#include "base/foreign.h"
#include "scene/afford.h"
#include "scene/scene.h"
#include "whit/whit_scene.h"

/* Limits for foreign code (importers and decoders in a child) by `params`, which may be NULL. */
static inline struct foreign_params load_foreign(const whit_load_params *params)
{
    struct foreign_params foreign = {0};
    if (params)
        foreign = (struct foreign_params){.cpu_s = params->import_limit_s,
                                          .clock_s = params->time_limit_s,
                                          .require_sandbox = params->require_sandbox,
                                          .cancel = params->cancel};
    uint64_t memory_bytes = params ? params->memory_limit_bytes : 0;
    foreign.memory_bytes = (memory_bytes ? memory_bytes : scene_default_memory_limit()) / 2;
    return foreign;
}

/* WHIT_ERROR_USAGE, logged after `path`, for params out of range, which may be NULL, and for a NULL
   path. */
WHIT_CHECK whit_result load_check(const whit_log *log, const char *path,
                                  const whit_load_params *params);

#define LOAD_MODELS ".obj .gltf .glb .ply .stl .fbx .dae .3mf .off"

/* Reads any supported file into a frozen scene: a .json scene file, or a model with an extension of
   LOAD_MODELS. Path `-` is standard input: its format is told by its first bytes, and it may not
   refer to files. On failure *out is NULL and one error naming the file and the reason (and the
   line, where the format has lines) was logged. NULL params mean defaults. */
WHIT_CHECK whit_result load_scene(const whit_log *log, const char *path,
                                  const whit_load_params *params, struct scene **out);

WHIT_CHECK whit_result load_scene_file(struct scene *scene, const char *path,
                                       const whit_load_params *params);

/* Reads a Radiance .hdr, .exr, .pfm or 8-bit picture (sRGB) into scene->environment. */
WHIT_CHECK whit_result load_environment(struct scene *scene, const char *path,
                                        const whit_load_params *params);
/* Makes the environment a black gradient, and gives back the memory of its map. */
void load_drop_environment(struct scene *scene);

#endif

/* Files into scenes. */
#ifndef LOAD_LOAD_H
#define LOAD_LOAD_H

#include <stddef.h>

#include "base/foreign.h"
#include "scene/afford.h"
#include "scene/scene.h"
#include "whit/whit_scene.h"

/* What foreign code gets by these params, which may be NULL. */
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

#define LOAD_MODELS ".obj .gltf .glb .ply .stl .fbx .dae .3mf .off"

/* Reads any supported file into a frozen scene: .json scene files, and models by LOAD_MODELS; for
   `-` standard input, whose first bytes tell what it is, and which names no files. On
   failure *out is NULL and one error naming the file and the reason (and the line, where the format
   has lines) was logged. NULL params mean defaults. */
WHIT_CHECK whit_result load_scene(const whit_log *log, const char *path,
                                  const whit_load_params *params, struct scene **out);

WHIT_CHECK whit_result load_scene_file(struct scene *scene, const char *path,
                                       const whit_load_params *params);

/* 8-bit texture from a file or from memory (`data` non-NULL; `path` then only names it). The name
   of an already loaded file gives the index it has. On failure a warning is noted in the scene and
   *index is a 1x1 magenta texture, unless `reason` is given: then nothing is noted or added,
   *reason says why and the result is WHIT_ERROR_INPUT. */
WHIT_CHECK whit_result load_texture(struct scene *scene, const char *path, const uint8_t *data,
                                    size_t size_bytes, const whit_load_params *params,
                                    uint32_t *index, const char **reason);
/* Radiance .hdr, .exr, .pfm or an 8-bit picture (sRGB) into scene->environment. */
WHIT_CHECK whit_result load_environment(struct scene *scene, const char *path,
                                        const whit_load_params *params);

#endif

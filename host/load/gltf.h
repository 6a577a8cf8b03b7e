/* glTF 2.0. whit itself reads JSON and buffers; Draco compression is decoded by assimp. */
#ifndef LOAD_GLTF_H
#define LOAD_GLTF_H

#include <jansson.h>

#include "load/model.h"
#include "load/part.h"

struct gltf_bytes {
    const uint8_t *data; /* NULL: the buffer has no data in this file */
    size_t size_bytes;
    uint8_t *owned; /* to free(); NULL: `data` is in the file's own bytes */
};

/* A material extension that whit does not draw, and how many materials have it. */
struct gltf_ignored {
    const char *extension;
    uint32_t first_material, materials;
};

/* A file being loaded. Arrays have an entry for each element of the JSON array of that name. */
struct gltf {
    struct scene *scene;
    const struct model_request *request;
    const uint8_t *file;
    size_t file_bytes;
    json_t *root;
    struct gltf_bytes chunk; /* binary chunk of a GLB */
    struct gltf_bytes *buffers;
    uint32_t *textures;    /* by image: scene's texture, SCENE_NONE: not loaded yet */
    uint32_t *materials;   /* scene's index */
    uint32_t *meshes;      /* scene's index, SCENE_NONE: no triangles, or not drawn */
    uint32_t *skinned;     /* by node: scene's index of its mesh with its skin applied */
    uint32_t *nodes;       /* scene's index, SCENE_NONE: not in the glTF scene that is drawn */
    uint32_t *parents;     /* by node: file's index of its parent, or SCENE_NONE */
    uint32_t *order;       /* drawn nodes of the file, parents first */
    bool *mesh_used;       /* by a node without a skin */
    struct affine *worlds; /* by node that is drawn: its transform at rest */
    struct gltf_ignored *ignored;
    struct key_table ignored_names; /* index in `ignored` by extension */
    uint64_t counted_bytes;         /* memory counted for buffers in files of their own */
    uint32_t buffer_count, image_count, material_count, mesh_count, node_count, order_count;
    uint32_t ignored_count, ignored_capacity;
    uint32_t default_material; /* SCENE_NONE until needed */
    bool only_names; /* textures are not loaded, but their pictures named for load_textures_ahead;
                        textures[i] is 0 once image i was named */
};

/* gltf_material.c, gltf_texture.c, gltf_animation.c */
struct gltf_place;

whit_result gltf_load_materials(struct gltf *gltf);
/* Reads a texture use from a textureInfo object. `visible`: a missing image becomes a magenta
   texture; else the use stays without a texture. */
whit_result gltf_texture_use(struct gltf *gltf, const json_t *in, const struct gltf_place *at,
                             const char *key, bool visible, struct scene_texture_use *out);
whit_result gltf_add_animations(struct gltf *gltf);

/* Loads the bytes of a .gltf or .glb; names in it are relative to the request's path. */
WHIT_CHECK whit_result gltf_load_bytes(struct scene *scene, const struct model_request *request,
                                       const uint8_t *data, size_t size_bytes);

#endif

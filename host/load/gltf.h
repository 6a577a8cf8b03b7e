/* glTF 2.0, read out of its JSON and buffers; what Draco has packed is unpacked by assimp. */
#ifndef LOAD_GLTF_H
#define LOAD_GLTF_H

#include <jansson.h>

#include "load/model.h"
#include "load/part.h"

struct gltf_bytes {
    const uint8_t *data; /* NULL: the buffer has no data in this file */
    size_t size_bytes;
    uint8_t *owned; /* NULL: part of the file */
};

/* An extension of materials that whit does not draw. */
struct gltf_ignored {
    const char *extension;
    uint32_t first_material, materials;
};

/* A file being loaded. Arrays run beside the JSON's own. */
struct gltf {
    struct scene *scene;
    const struct model_request *request;
    const uint8_t *file;
    size_t file_bytes;
    json_t *root;
    struct gltf_bytes chunk; /* of a GLB */
    struct gltf_bytes *buffers;
    uint32_t *textures;  /* scene textures of images, SCENE_NONE: not loaded yet */
    uint32_t *materials; /* in the scene */
    uint32_t *meshes;    /* in the scene, SCENE_NONE: no triangles, or not drawn */
    uint32_t *nodes;     /* in the scene, SCENE_NONE: not in the drawn scene */
    uint32_t *parents;   /* of nodes, in the file */
    uint32_t *order;     /* drawn nodes of the file, parents first */
    bool *mesh_used;
    struct gltf_ignored *ignored;
    struct key_table ignored_names; /* their index */
    uint64_t counted_bytes;         /* of buffers in files of their own */
    uint32_t buffer_count, image_count, material_count, mesh_count, node_count, order_count;
    uint32_t ignored_count, ignored_capacity;
    uint32_t default_material; /* SCENE_NONE until needed */
};

/* gltf_material.c, gltf_texture.c, gltf_animation.c */
struct gltf_place;

whit_result gltf_load_materials(struct gltf *gltf);
/* A texture use out of a textureInfo object. `visible`: a missing picture is shown as such. */
whit_result gltf_texture_use(struct gltf *gltf, const json_t *in, const struct gltf_place *at,
                             const char *key, bool visible, struct scene_texture_use *out);
whit_result gltf_add_animations(struct gltf *gltf);

/* .gltf and .glb */
WHIT_CHECK whit_result gltf_load(struct scene *scene, const struct model_request *request);
/* The same of a file in memory; what it names lies beside the request's path. */
WHIT_CHECK whit_result gltf_load_bytes(struct scene *scene, const struct model_request *request,
                                       const uint8_t *data, size_t size_bytes);

#endif

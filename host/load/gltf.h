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

/* A file being loaded. Arrays run beside the JSON's own. */
/* An extension of materials that whit does not draw. */
struct gltf_ignored {
    const char *extension;
    uint32_t first_material, materials;
};

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
    struct table ignored_names; /* their index */
    uint64_t counted_bytes;     /* of buffers in files of their own */
    uint32_t buffer_count, image_count, material_count, mesh_count, node_count, order_count;
    uint32_t ignored_count, ignored_capacity;
    uint32_t default_material; /* SCENE_NONE until needed */
};

/* --- gltf_json.c: typed access. All log `path: place: what is wrong` and return false. ---------
 */

enum { GLTF_PLACE = 96 };

/* Where something is in the JSON, for errors: "nodes[3]". */
struct gltf_place {
    char text[GLTF_PLACE];
};

struct gltf_place gltf_place(const char *format, ...) WHIT_PRINTF(1, 2);
bool gltf_fail(const struct gltf *gltf, const struct gltf_place *at, const char *format, ...)
    WHIT_PRINTF(3, 4);

/* Members that are absent leave *out as it is (pointers become NULL, indices SCENE_NONE). */
bool gltf_object(const struct gltf *gltf, const json_t *in, const struct gltf_place *at,
                 const char *key, json_t **out);
bool gltf_array(const struct gltf *gltf, const json_t *in, const struct gltf_place *at,
                const char *key, json_t **out);
bool gltf_string(const struct gltf *gltf, const json_t *in, const struct gltf_place *at,
                 const char *key, const char **out);
bool gltf_bool(const struct gltf *gltf, const json_t *in, const struct gltf_place *at,
               const char *key, bool *out);
bool gltf_number(const struct gltf *gltf, const json_t *in, const struct gltf_place *at,
                 const char *key, double *out);
/* Exactly `count` numbers. */
bool gltf_numbers(const struct gltf *gltf, const json_t *in, const struct gltf_place *at,
                  const char *key, uint32_t count, double *out);
bool gltf_floats(const struct gltf *gltf, const json_t *in, const struct gltf_place *at,
                 const char *key, uint32_t count, float *out);
/* A whole number of at least 0 and at most `most`. */
bool gltf_whole(const struct gltf *gltf, const json_t *in, const struct gltf_place *at,
                const char *key, uint64_t max, uint64_t *out);
/* An index below `count`. */
bool gltf_index(const struct gltf *gltf, const json_t *in, const struct gltf_place *at,
                const char *key, uint32_t count, uint32_t *out);
bool gltf_index_value(const struct gltf *gltf, const json_t *value, const struct gltf_place *at,
                      uint32_t count, uint32_t *out);
/* extensions[name], or NULL. */
bool gltf_extension(const struct gltf *gltf, const json_t *in, const struct gltf_place *at,
                    const char *name, json_t **out);
/* Entry `index` of the root's array `key`, which must be an object. */
bool gltf_item(const struct gltf *gltf, const char *key, uint32_t index, struct gltf_place *at,
               json_t **out);
/* 0 when there is no such array. */
uint32_t gltf_count(const struct gltf *gltf, const char *key);

/* --- gltf_buffer.c -----------------------------------------------------------------------------
 */

whit_result gltf_load_buffers(struct gltf *gltf);
/* Bytes of a buffer view; `stride` (may be NULL): its byteStride, 0 when it has none. */
bool gltf_view(const struct gltf *gltf, uint32_t view, const uint8_t **data, size_t *size_bytes,
               uint32_t *stride);
/* Bytes behind a data: URI (*data is malloc'ed); WHIT_ERROR_INPUT when it is not one that can be
   read. Says nothing. */
WHIT_CHECK whit_result gltf_decode_uri(const char *uri, uint8_t **data, size_t *size_bytes);
/* The path of a relative URI beside the file, %20 and the like decoded; free() it. */
char *gltf_uri_path(const struct gltf *gltf, const char *uri);

/* --- gltf_accessor.c ---------------------------------------------------------------------------
 */

enum { GLTF_UNSIGNED_SHORT = 5123, GLTF_FLOAT = 5126 };

struct gltf_accessor {
    uint32_t index; /* its own */
    uint32_t component, components, count, view;
    uint64_t offset;
    const json_t *sparse; /* or NULL */
    bool normalized;
};

bool gltf_accessor(const struct gltf *gltf, uint32_t index, struct gltf_accessor *out);
/* Whether its components are unsigned integers. */
bool gltf_is_whole(const struct gltf_accessor *accessor);
/* Whether all elements lie within the accessor's view. What follows takes only such. */
bool gltf_check_elements(const struct gltf *gltf, const struct gltf_accessor *accessor);
/* All elements as floats, normalized integers in [-1, 1], in rows of `width`, which is at least
   what an element has and is filled up with ones. */
bool gltf_read_rows(const struct gltf *gltf, const struct gltf_accessor *accessor, uint32_t width,
                    float *out);
/* All elements of one unsigned integer each. */
bool gltf_read_whole(const struct gltf *gltf, const struct gltf_accessor *accessor, uint32_t *out);
/* All elements as floats; `components` must be what the accessor has. *out is malloc'ed. */
bool gltf_read_floats(const struct gltf *gltf, uint32_t index, uint32_t components, float **out,
                      uint32_t *count);

/* --- triangles ---------------------------------------------------------------------------------
 */

struct gltf_primitive {
    struct gltf_place at;
    uint32_t mode, material, vertex_count, corner_count;
    /* By enum import_array; a count of 0: absent. */
    struct gltf_accessor accessors[IMPORT_ARRAY_COUNT];
    const json_t *draco; /* the extension, or NULL */
};

struct gltf_attribute {
    const char *name, *type;
    uint32_t least; /* components that the file must give */
};
extern const struct gltf_attribute gltf_attributes[IMPORT_INDICES];

/* --- gltf_draco.c ------------------------------------------------------------------------------
 */

/* Whether the array comes from Draco, and not from its accessor. */
bool gltf_is_packed(const struct gltf_primitive *primitive, enum import_array array);
/* Fills `part` with the arrays that Draco has packed, and the indices. */
whit_result gltf_unpack(const struct gltf *gltf, const struct gltf_primitive *primitive,
                        struct part *part);

/* --- the rest ----------------------------------------------------------------------------------
 */

whit_result gltf_load_materials(struct gltf *gltf);
/* A texture use out of a textureInfo object. `visible`: a missing picture is shown as such. */
whit_result gltf_texture_use(struct gltf *gltf, const json_t *in, const struct gltf_place *at,
                             const char *key, bool visible, struct scene_texture_use *out);
/* Node tree: checks it and finds what is drawn. */
whit_result gltf_plan_nodes(struct gltf *gltf);
whit_result gltf_load_meshes(struct gltf *gltf);
whit_result gltf_add_nodes(struct gltf *gltf);
whit_result gltf_add_animations(struct gltf *gltf);

#endif

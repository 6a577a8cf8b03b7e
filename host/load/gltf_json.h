/* Typed access to the JSON. On an error, functions log `path: place: what is wrong`, give false. */
#ifndef LOAD_GLTF_JSON_H
#define LOAD_GLTF_JSON_H

#include "load/gltf.h"

enum { GLTF_PLACE = 96 };

/* A place in the JSON, for errors: "nodes[3]". */
struct gltf_place {
    char text[GLTF_PLACE];
};

struct gltf_place gltf_place(const char *format, ...) WHIT_PRINTF(1, 2);
bool gltf_fail(const struct gltf *gltf, const struct gltf_place *at, const char *format, ...)
    WHIT_PRINTF(3, 4);

/* If the member is absent, numbers in *out stay as they are, pointers become NULL, and indices
   SCENE_NONE. */
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
/* Reads an array of exactly `count` numbers. */
bool gltf_numbers(const struct gltf *gltf, const json_t *in, const struct gltf_place *at,
                  const char *key, uint32_t count, double *out);
bool gltf_floats(const struct gltf *gltf, const json_t *in, const struct gltf_place *at,
                 const char *key, uint32_t count, float *out);
/* Reads a whole number of at least 0 and at most `max`. */
bool gltf_whole(const struct gltf *gltf, const json_t *in, const struct gltf_place *at,
                const char *key, uint64_t max, uint64_t *out);
/* Reads an index, which must be below `count`. */
bool gltf_index(const struct gltf *gltf, const json_t *in, const struct gltf_place *at,
                const char *key, uint32_t count, uint32_t *out);
bool gltf_index_value(const struct gltf *gltf, const json_t *value, const struct gltf_place *at,
                      uint32_t count, uint32_t *out);
/* Gives the object extensions[name], or NULL. */
bool gltf_extension(const struct gltf *gltf, const json_t *in, const struct gltf_place *at,
                    const char *name, json_t **out);
/* Entry `index` of the root's array `key`, which must be an object. */
bool gltf_item(const struct gltf *gltf, const char *key, uint32_t index, struct gltf_place *at,
               json_t **out);
/* Length of the root's array `key`; 0: there is none. */
uint32_t gltf_count(const struct gltf *gltf, const char *key);

#endif

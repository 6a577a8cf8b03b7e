/* glTF accessors. Functions that return false have logged an error. */
#ifndef LOAD_GLTF_ACCESSOR_H
#define LOAD_GLTF_ACCESSOR_H

#include "load/gltf.h"

enum { GLTF_UNSIGNED_BYTE = 5121, GLTF_UNSIGNED_SHORT = 5123, GLTF_FLOAT = 5126 };

struct gltf_accessor {
    uint32_t index; /* its own index in the file */
    uint32_t component, components, count, view;
    uint64_t offset;
    const json_t *sparse; /* or NULL */
    bool normalized;
};

bool gltf_accessor(const struct gltf *gltf, uint32_t index, struct gltf_accessor *out);
/* Whether its components are unsigned integers. */
bool gltf_is_whole(const struct gltf_accessor *accessor);
/* Whether all elements lie within the accessor's view; without a view they are zeros. The functions
   below need that. */
bool gltf_check_elements(const struct gltf *gltf, const struct gltf_accessor *accessor);
/* Reads all elements as floats, normalized integers in [-1, 1], into rows of `width` floats. Where
   an element has fewer components, the rest of its row is 1. */
bool gltf_read_rows(const struct gltf *gltf, const struct gltf_accessor *accessor, uint32_t width,
                    float *out);
/* Reads all elements, each of which is one unsigned integer. */
bool gltf_read_whole(const struct gltf *gltf, const struct gltf_accessor *accessor, uint32_t *out);
/* Reads all elements as floats; fails unless each has `components`. *out is malloc'ed. */
bool gltf_read_floats(const struct gltf *gltf, uint32_t index, uint32_t components, float **out,
                      uint32_t *count);

#endif

/* glTF buffers and URIs. */
#ifndef LOAD_GLTF_BUFFER_H
#define LOAD_GLTF_BUFFER_H

#include "load/gltf.h"

whit_result gltf_load_buffers(struct gltf *gltf);
/* Gives the bytes of a buffer view; `stride` (may be NULL): its byteStride, 0 when it has none. */
bool gltf_view(const struct gltf *gltf, uint32_t view, const uint8_t **data, size_t *size_bytes,
               uint32_t *stride);
/* Decodes a data: URI (*data is malloc'ed). WHIT_ERROR_INPUT, not logged, when it is not one that
   can be read. */
WHIT_CHECK whit_result gltf_decode_uri(const char *uri, uint8_t **data, size_t *size_bytes);
/* The name of the file in a URI, with %20 and the like decoded; free() it. */
char *gltf_uri_name(const char *uri);

#endif

/* Mesh trees in a file, for scenes of the same geometry. */
#ifndef ACCEL_BVH_FILE_H
#define ACCEL_BVH_FILE_H

#include <stddef.h>

#include "accel/accel.h"

/* Appears whole or not at all. The same trees give the same bytes. WHIT_ERROR_USAGE for scenes that
   are flattened or have no trees. */
WHIT_CHECK whit_result bvh_file_write(const struct accel *accel, const char *path);

/* Fills `trees`, zeroed and one a mesh of `scene`, and says in *params how they were built; its
   thread count stays. Trusts nothing: a file that is cut short, damaged, of another scene, or whose
   trees are no trees of its meshes is refused with one error, and `trees` are left finished.
   WHIT_ERROR_INPUT. */
WHIT_CHECK whit_result bvh_file_read(const struct log *log, const char *path,
                                     const struct scene *scene, struct bvh_params *params,
                                     struct bvh *trees);
/* The same of a file's bytes; `path` is for messages. */
WHIT_CHECK whit_result bvh_file_parse(const struct log *log, const char *path, const uint8_t *data,
                                      size_t size_bytes, const struct scene *scene,
                                      struct bvh_params *params, struct bvh *trees);

#endif

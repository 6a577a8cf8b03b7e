/* Repairs and checks the elements of a PLY, before assimp gets them. */
#ifndef LOAD_PLY_ELEMENTS_H
#define LOAD_PLY_ELEMENTS_H

#include <stddef.h>
#include <stdint.h>

#include "scene/scene.h"

/* Checks that the header ends, and that its counts of elements are no larger than the data's size
   in bytes: assimp would read on for ever, and trusts counts. Logs an error with its line. */
WHIT_CHECK whit_result ply_check(const whit_log *log, const char *path, const uint8_t *data,
                                 size_t size_bytes);
/* Converts triangle strips to faces, since assimp 5.2 reads only the last triangle of a strip, in a
   file that ply_check accepted. Replaces *data, which is malloc'ed with a zero byte behind it,
   before and after. Damaged strips are logged. */
WHIT_CHECK whit_result ply_replace_strips(const whit_log *log, const char *path, uint8_t **data,
                                          size_t *size_bytes);
/* The parts of a PLY's colours that whit reads itself. texture: the picture that the header names,
   to free(), or NULL. A number of a vertex colour is scale times assimp's one plus offset, which
   assimp gets wrong for all integers but bytes without a sign; [0]: red, green, blue, [1]: alpha.
 */
struct ply_paint {
    char *texture;
    bool more_textures; /* the header names others, which are not drawn */
    float scale[2], offset[2];
};

/* Logs an error if an element of a file that ply_check accepted is cut short or missing, or if a
   type is unknown: assimp 5.2 would crash, or draw what is left. Notes colours of faces and
   materials, which are not read. Removes all other elements than vertices and faces, faces without
   corners, and comments in the header: assimp skips wrong lines and bytes for the ones, and loses
   the property behind the others. Vertices go in front of faces, and `diffuse_red` becomes `red`,
   as assimp wants them. Replaces *data, which is malloc'ed with a zero byte behind
   it, before and after. */
WHIT_CHECK whit_result ply_check_elements(struct scene *scene, const char *path, uint8_t **data,
                                          size_t *size_bytes, struct ply_paint *paint);

#endif

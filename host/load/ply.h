/* Checks and repairs a PLY, before assimp gets it. */
#ifndef LOAD_PLY_H
#define LOAD_PLY_H

#include <stddef.h>
#include <stdint.h>

#include "scene/scene.h"

/* The parts of a PLY's colours that whit reads itself. texture: the picture that the header names,
   to free(), or NULL. A number of a vertex colour is scale times assimp's one plus offset, which
   assimp gets wrong for all integers but bytes without a sign; [0]: red, green, blue, [1]: alpha.
 */
struct ply_paint {
    char *texture;
    bool more_textures; /* the header names others, which are not drawn */
    float scale[2], offset[2];
};

/* Logs an error if the header does not end, if an element is cut short or missing, or if a type is
   unknown: assimp 5.2 would read on for ever, crash, or draw what is left. Converts triangle strips
   to faces, of which assimp reads only the last triangle. Notes colours of faces and materials,
   which are not read. Removes all other elements than vertices and faces, faces without corners,
   blank lines, and comments in the header: assimp skips wrong lines and bytes for the ones, and
   loses the element or the property behind the others. Vertices go in front of faces, and
   `diffuse_red` becomes `red`, as assimp wants them. Replaces *data, which is malloc'ed with a zero
   byte behind it, before and after. */
WHIT_CHECK whit_result ply_prepare(struct scene *scene, const char *path, uint8_t **data,
                                   size_t *size_bytes, struct ply_paint *paint);

#endif

/* Repairs and reads the text of an OBJ, before assimp gets it. */
#ifndef LOAD_OBJ_H
#define LOAD_OBJ_H

#include <stddef.h>

#include "load/mtl.h"

/* Writes the text as UTF-8 in the lines that assimp 5.2 and the functions below read: without a
   byte order mark, comments and blanks around a line, with \n behind every line and lines joined
   that a backslash continues (each line keeps its number), with a zero in ` .5`, with a second
   coordinate, 0, where a `vt` has one, and with a white colour behind each `v` without one if
   others have colours. Replaces *data (malloc'ed, zero-terminated). False when memory runs out;
   *data is then still to be freed. */
WHIT_CHECK bool obj_repair_text(uint8_t **data, size_t *size_bytes);

/* The line number, from 1, of the face with the most words in a repaired text; 0: there is no
   face. */
uint32_t obj_longest_face(const char *text);

/* Logs an error if a face of a repaired text names a vertex that is not there. Texture coordinates
   and normals that are not there are noted: assimp 5.2 then drops them for the whole group. */
WHIT_CHECK whit_result obj_check_faces(struct scene *scene, const char *path, const char *text);

/* In a repaired text with smoothing groups and no normals, puts a normal that stands for the group
   (its x is above 0) in the place of `s N`, and gives it to the corners of the faces below, or none
   below `s off`; parts_smooth reads it, since assimp 5.2 skips `s`. Replaces *data, as above.
   *has_groups: whether it did. */
WHIT_CHECK bool obj_mark_smooth_groups(uint8_t **data, size_t *size_bytes, bool *has_groups);

/* Reads the material libraries that the text names; if it names none, the one that is called like
   the OBJ, beside it. Missing ones are noted. */
WHIT_CHECK whit_result obj_read_libraries(struct scene *scene, const char *path, const char *text,
                                          struct mtl_library *library);

#endif

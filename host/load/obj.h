/* Repairs and reads the text of an OBJ, before assimp gets it. */
#ifndef LOAD_OBJ_H
#define LOAD_OBJ_H

#include <stddef.h>

#include "load/mtl.h"

/* Converts UTF-16 to UTF-8, and adds the zero to numbers without a digit before the point (` .5`),
   which assimp 5.2 does not read as numbers. Replaces *data (malloc'ed, zero-terminated). False
   when memory runs out; *data is then intact. */
WHIT_CHECK bool obj_repair_text(uint8_t **data, size_t *size_bytes);

/* The line number, from 1, on which the face with the most words starts; 0: there is no face. A
   line that ends with a backslash continues on the next one. */
uint32_t obj_longest_face(const char *text);

/* Reads the material libraries that the text names; if it names none, the one that is called like
   the OBJ, beside it. Missing ones are noted. */
WHIT_CHECK whit_result obj_read_libraries(struct scene *scene, const char *path, const char *text,
                                          struct mtl_library *library);

#endif

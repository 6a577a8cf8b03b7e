/* The text of an OBJ before assimp sees it. */
#ifndef LOAD_OBJ_H
#define LOAD_OBJ_H

#include <stddef.h>

#include "load/mtl.h"

/* UTF-16 becomes UTF-8, and numbers without a digit before the point (` .5`), which assimp 5.2
   does not take for numbers, get their zero. Replaces *data (malloc'ed, zero-terminated); false
   when memory runs out, *data intact. */
WHIT_CHECK bool obj_repair_text(uint8_t **data, size_t *size_bytes);

/* Number of the line on which the face with the most words starts; 0: there is no face. A line that
   ends with a backslash goes on in the next one. */
uint32_t obj_longest_face(const char *text);

/* Reads the material libraries that the text names, or the one beside the OBJ with its name.
   Missing ones are noted. */
WHIT_CHECK whit_result obj_read_libraries(struct scene *scene, const char *path, const char *text,
                                          struct mtl_library *library);

#endif

/* Checks and repairs STL and OFF files before assimp gets them. */
#ifndef LOAD_CUT_H
#define LOAD_CUT_H

#include "scene/scene.h"

/* Logs an error if a binary STL has fewer triangles than it says. assimp 5.2 reads none with bytes
   behind its triangles: these are cut off *size_bytes, and noted. It knows the keywords of a text
   in lower case alone, also within names, and no blank in front of them: writes them so. A zero
   byte follows `data`, before and after. */
WHIT_CHECK whit_result cut_check_stl(struct scene *scene, const char *path, uint8_t *data,
                                     size_t *size_bytes);
/* Logs an error if an OFF has fewer vertices or faces, each in a line of its own, than it says,
   or a face an index out of range: assimp 5.2 would crash, or take another vertex. Notes faces that
   assimp drops, and their colours. Removes comments, which assimp takes for vertices or faces, and
   writes the keyword if it is left out. What is no OFF is left to assimp. Replaces *data
   (malloc'ed, zero-terminated). */
WHIT_CHECK whit_result cut_check_off(struct scene *scene, const char *path, uint8_t **data,
                                     size_t *size_bytes);

#endif

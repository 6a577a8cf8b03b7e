/* Refuses files that are cut short, before assimp gets them. */
#ifndef LOAD_CUT_H
#define LOAD_CUT_H

#include "scene/scene.h"

/* Logs an error if a binary STL has fewer triangles than it says. assimp 5.2 reads none with bytes
   behind its triangles: these are cut off *size_bytes, and noted. */
WHIT_CHECK whit_result cut_check_stl(struct scene *scene, const char *path, const uint8_t *data,
                                     size_t *size_bytes);
/* Logs an error if an OFF (`text` is zero-terminated) has fewer vertices or faces, each in a line
   of its own, than it says: assimp 5.2 would crash. Notes faces that assimp drops. What is no OFF
   is left to assimp. */
WHIT_CHECK whit_result cut_check_off(struct scene *scene, const char *path, const char *text);

#endif

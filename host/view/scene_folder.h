/* The scenes and models in a folder, which the arrow keys go through. */
#ifndef VIEW_SCENE_FOLDER_H
#define VIEW_SCENE_FOLDER_H

#include <stdbool.h>
#include <stddef.h>

/* Finds the scene that stands `by` places behind `path` in its folder, by name; behind the last one
   comes the first. A path that is not there any more counts as standing before the first. False:
   the folder has no other scene. */
bool scene_folder_find(const char *path, int by, char *found, size_t found_bytes);

#endif

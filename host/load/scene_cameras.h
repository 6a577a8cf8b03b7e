/* Cameras of scene files, and files with nothing but cameras. */
#ifndef LOAD_SCENE_CAMERAS_H
#define LOAD_SCENE_CAMERAS_H

#include "load/scene_reader.h"

/* Adds the cameras of a file that has nothing else: a JSON array of cameras as in scene files, or
   one per line. WHIT_ERROR_INPUT, logged, if there is none or if one is animated. */
WHIT_CHECK whit_result load_cameras(struct scene *scene, const char *path);

/* Each adds what it reads to the scene. */
bool reader_camera(struct reader *reader, const struct place *place, const json_t *object);
bool reader_cameras(struct reader *reader, const struct place *place, const json_t *value);

#endif

/* Cameras of files. */
#ifndef LOAD_SCENE_CAMERAS_H
#define LOAD_SCENE_CAMERAS_H

#include "load/scene_reader.h"

/* The cameras of a file of nothing else into a scene: an array of what scene files have, or one of
   them a line. WHIT_ERROR_INPUT, logged, for none, and for one that moves. */
WHIT_CHECK whit_result load_cameras(struct scene *scene, const char *path);

/* Into the scene. */
bool reader_camera(struct reader *reader, const struct place *place, const json_t *object);
bool reader_cameras(struct reader *reader, const struct place *place, const json_t *value);

#endif

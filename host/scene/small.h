/* A built-in scene, for commands that need some scene and were given none. */
#ifndef SCENE_SMALL_H
#define SCENE_SMALL_H

#include "scene/scene.h"

/* A frozen scene with rays of every kind: a floor with a mirroring box, a glass ball and a diffuse
   one, a light and a camera. NULL: no memory, which was logged. */
struct scene *scene_small(const whit_log *log);

#endif

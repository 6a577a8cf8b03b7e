/* A scene of whit's own, for what asks for some scene and is given none. */
#ifndef SCENE_SMALL_H
#define SCENE_SMALL_H

#include "scene/scene.h"

/* A floor with a box that mirrors, a ball of glass and a dull one on it, a light with a place and a
   camera: a kind of ray of every stage. Frozen. NULL: no memory, which was logged. */
struct scene *scene_small(const whit_log *log);

#endif

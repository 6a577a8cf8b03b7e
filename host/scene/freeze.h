/* The parts of scene_freeze, for use inside of host/scene/ alone. */
#ifndef SCENE_FREEZE_H
#define SCENE_FREEZE_H

#include "scene/scene.h"

/* freeze.c: the second half of scene_freeze, after all stated values were checked: adds what is
   derived from them, and sets `frozen`. */
WHIT_CHECK whit_result freeze_complete(struct scene *scene);

/* clean.c: drops triangles that cannot be traced, mends attributes, sets bounds. */
WHIT_CHECK whit_result freeze_clean_mesh(struct scene *scene, uint32_t mesh);

/* emitters.c: adds lights that stand for emissive surfaces. *added is how many; 0 when the scene
   has none that would light it. */
WHIT_CHECK whit_result freeze_sample_emitters(struct scene *scene, const struct scene_pose *pose,
                                              uint32_t *added);

/* defaults.c: camera, lights, ambient light and environment where the file has none. */
WHIT_CHECK whit_result freeze_add_defaults(struct scene *scene);

#endif

/* Which effects a scene calls for. */
#ifndef SCENE_EFFECTS_H
#define SCENE_EFFECTS_H

#include "scene/scene.h"

const char *scene_effect_name(enum scene_effect effect);
/* `functions`: functions of a user may read lights that light nothing, so these call for their
   effects too. */
void scene_effects_scan(const struct scene *scene, bool functions, struct scene_effects *out);
enum { WORN_BY_TRIANGLES = 1, WORN_BY_SPHERES = 2 };
/* By material: WORN_BY_* bits of the primitives that have it; free() it. NULL: out of memory, where
   the functions below count all materials as used. Effects of unused ones, as in material
   libraries, are not compiled. */
uint8_t *scene_worn_materials(const struct scene *scene);
/* The first material of this name that some primitive uses; name "": the first used one of any
   name. SCENE_NONE: there is none. */
uint32_t scene_find_worn(const struct scene *scene, const char *name);

/* Goes through the materials of this class that primitives use: adds the effects that they call
   for, and gives how many materials they are. */
uint32_t scene_effects_scan_materials(const struct scene *scene, enum scene_materials which,
                                      struct scene_effects *out);

#endif

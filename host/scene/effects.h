/* Which effects a scene calls for. */
#ifndef SCENE_EFFECTS_H
#define SCENE_EFFECTS_H

#include "scene/scene.h"

const char *scene_effect_name(enum scene_effect effect);
void scene_effects_scan(const struct scene *scene, struct scene_effects *out);
/* The first material of this name that some primitive uses; name "": the first used one of any
   name. SCENE_NONE: there is none. */
uint32_t scene_find_worn(const struct scene *scene, const char *name);

/* Adds the effects that materials of this class call for, by those that primitives use; gives how
   many these are. */
uint32_t scene_effects_scan_materials(const struct scene *scene, enum scene_materials which,
                                      struct scene_effects *out);

#endif

/* Which effects a scene calls for. */
#ifndef SCENE_EFFECTS_H
#define SCENE_EFFECTS_H

#include "scene/scene.h"

const char *scene_effect_name(enum scene_effect effect);
void scene_effects_scan(const struct scene *scene, struct scene_effects *out);
/* The first material of that name, "": of any, that some primitive wears; SCENE_NONE: there is
 * none.
 */
uint32_t scene_find_worn(const struct scene *scene, const char *name);

/* Adds what these materials call for; gives how many of them some primitive wears. */
uint32_t scene_effects_scan_materials(const struct scene *scene, enum scene_materials which,
                                      struct scene_effects *out);

#endif

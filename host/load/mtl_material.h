/* Entries of material libraries as materials of a scene. */
#ifndef LOAD_MTL_MATERIAL_H
#define LOAD_MTL_MATERIAL_H

#include "load/mtl.h"

/* Calls load_texture_soon for the pictures that mtl_material will load. */
void mtl_name_pictures(struct scene *scene, const struct mtl_entry *entry,
                       const whit_load_params *params);
/* Converts the entry to a material, and loads its textures; release *out with
   scene_material_finish. */
WHIT_CHECK whit_result mtl_material(struct scene *scene, const struct mtl_entry *entry,
                                    const whit_load_params *params, struct scene_material *out);

#endif

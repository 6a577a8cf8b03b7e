/* Effects, and the specialization constants that they switch. */
#ifndef RENDER_EFFECTS_H
#define RENDER_EFFECTS_H

#include "render/renderer.h"

/* WHIT_ERROR_USAGE, logged, for effects that cannot be added or removed. */
WHIT_CHECK whit_result effects_check(const whit_log *log, const whit_renderer_params *params);
/* Changes `effects`, at first what the scene calls for, by what `params` add and remove. An effect
   that needs another one is off where that one is off. */
void effects_choose(const whit_renderer_params *params, struct scene_effects *effects);
/* Sets the constants of `spec` that effects switch. */
void effects_switch(const struct scene_effects *effects, struct gpu_spec *spec);
/* Restricts texture slots and sampling to what the materials of the set `which` use. */
void effects_narrow_textures(const struct renderer *renderer, enum scene_materials which,
                             struct gpu_spec *spec);
/* Switches off in a shading kernel what no material of its class (CLASS_*) needs. */
void effects_narrow_to_class(const struct renderer *renderer, uint32_t material_class,
                             struct gpu_spec *spec);

#endif

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

#endif

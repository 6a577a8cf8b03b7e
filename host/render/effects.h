/* Effects: what they switch in kernels. */
#ifndef RENDER_EFFECTS_H
#define RENDER_EFFECTS_H

#include "render/renderer.h"

/* WHIT_ERROR_USAGE, logged, for effects that cannot be added or left out. */
WHIT_CHECK whit_result effects_check(const whit_log *log, const whit_renderer_params *params);
/* What the scene calls for, as `effects` says, more and less what `params` say; what
   does nothing without something else that is off is off too. */
void effects_choose(const whit_renderer_params *params, struct scene_effects *effects);
/* Sets the constants that effects switch. */
void effects_switch(const struct scene_effects *effects, struct gpu_spec *spec);

#endif

/* The functions of params.shader (a user's file), and what they change of a picture. */
#ifndef RENDER_HOOKS_H
#define RENDER_HOOKS_H

#include "render/renderer.h"

void hooks_take(struct renderer *renderer);
/* The shader's code for a kernel; for a probe of a file with dbg(x) the code that records. NULL:
   the shader has none, so whit's own kernel serves. */
const struct shader_code *hooks_code(const struct target *target, const char *kernel);
/* The number of dbg(x) calls in the shader if `target` records their values; else 0. */
uint32_t hooks_dbg_count(const struct target *target);
/* The number of the shader's aovs. A probe calls them only where the file has dbg(x). */
uint32_t hooks_aov_count(const struct target *target);
/* WHIT_ERROR_USAGE, logged, for a step_aov above the number of aovs. */
WHIT_CHECK whit_result hooks_check_step_aov(const struct renderer *renderer, uint32_t step_aov);
/* Sets renderer->sliders. WHIT_ERROR_USAGE, logged, for sliders that the shader does not have. */
WHIT_CHECK whit_result hooks_read_sliders(struct renderer *renderer, const char *sliders);
/* Finds the material of intersect()'s shape in the scene. Where no primitive has a material of that
   name, the first material that any primitive has stands in. */
WHIT_CHECK whit_result hooks_find_material(struct renderer *renderer);
/* Warns if no primitive has the material of intersect()'s shape, and suggests the name that comes
   nearest. */
void hooks_warn_material(const struct renderer *renderer);
/* Clears the words of the status buffer about loops without fuel and wrong answers of
   intersect(). */
WHIT_CHECK whit_result hooks_clear_status(const struct target *target);
/* These append to `text`: the name of the user's file whose functions the picture has, if there is
   one; its loops, any of which the driver may have ended; the loop that ran out of iterations, as
   the status buffer names it; the wrong answer of intersect(), likewise. */
void hooks_describe_file(const struct target *target, char *text, size_t text_bytes);
void hooks_describe_loops(const struct target *target, char *text, size_t text_bytes);
void hooks_describe_fuel(const struct target *target, char *text, size_t text_bytes);
void hooks_describe_shape(const struct target *target, char *text, size_t text_bytes);

#endif

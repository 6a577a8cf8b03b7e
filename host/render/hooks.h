/* What the functions of params.shader call for, beside what the scene does. */
#ifndef RENDER_HOOKS_H
#define RENDER_HOOKS_H

#include "render/renderer.h"

void hooks_take(struct renderer *renderer);
/* Its code of a kernel, for a probe with dbg(x) that which records; NULL: whit's own serves. */
const struct shader_code *hooks_code(const struct target *target, const char *kernel);
/* How often dbg(x) stands in it, where `target` records what it is; else 0. */
uint32_t hooks_dbg_count(const struct target *target);
/* Its functions whose values are kept beside the colour. A probe calls them for what dbg(x) is. */
uint32_t hooks_aov_count(const struct target *target);
/* WHIT_ERROR_USAGE, logged, for sliders that the shader has not. */
WHIT_CHECK whit_result hooks_read_sliders(struct renderer *renderer, const char *sliders);
/* Finds the material of its shape in the scene, which may have none of that name. */
WHIT_CHECK whit_result hooks_find_material(struct renderer *renderer);
/* Forgets loops that had no fuel left, and answers for a shape that were wrong. */
WHIT_CHECK whit_result hooks_clear_status(const struct target *target);
/* Adds to the text which file has functions in the place of whit's; nothing where there is none. */
void hooks_describe_file(const struct renderer *renderer, char *text, size_t text_bytes);
/* What ran out of iterations, as the status buffer names it. */
void hooks_describe_fuel(const struct target *target, char *text, size_t text_bytes);
/* Which answer for a shape was wrong, likewise. */
void hooks_describe_shape(const struct target *target, char *text, size_t text_bytes);

#endif

/* Sliders of a user's file. */
#ifndef SHADER_SLIDERS_H
#define SHADER_SLIDERS_H

#include "shader/program.h"

/* The GLSL that declares the sliders; free() it. NULL: no memory. */
char *shader_sliders_declare(const whit_shader *shader);
/* Removes from `text`, "NAME=VALUE,NAME=VALUE", what the shader has no use for. True: something was
   removed. */
bool shader_sliders_keep(const whit_shader *shader, char *text);
/* Sets the values of all sliders: those of the file, changed by `text`, "NAME=VALUE,NAME=VALUE"
   (may be NULL or ""). Colours become linear. `skip`: pairs that the file has no use for are
   ignored. False: `why` has the reason, and `values` is not valid. */
bool shader_sliders_read(const whit_shader *shader, const char *text, bool skip,
                         float values[SHADER_SLIDERS_MAX], char *why, size_t why_bytes);

#endif

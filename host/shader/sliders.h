/* Sliders of files. */
#ifndef SHADER_SLIDERS_H
#define SHADER_SLIDERS_H

#include "shader/program.h"

/* The GLSL that declares the sliders; free() it. NULL: no memory. */
char *shader_sliders_declare(const whit_shader *shader);
/* The values of all sliders, of which `text`, "NAME=VALUE,NAME=VALUE", changes some; NULL or "":
   none. Colours come out linear. With `skip`, pairs that are no use are left out. False: why not,
   and `values` means nothing. */
bool shader_sliders_read(const whit_shader *shader, const char *text, bool skip,
                         float values[SHADER_SLIDERS_MAX], char *why, size_t why_bytes);

#endif

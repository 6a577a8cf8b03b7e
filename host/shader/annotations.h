/* Annotations: the lines `//@ ...` of a user's files. */
#ifndef SHADER_ANNOTATIONS_H
#define SHADER_ANNOTATIONS_H

#include "shader/program.h"

/* Reads the lines `//@ ...` of all files into `shader`. WHIT_ERROR_INPUT: `errors` has what is
   wrong, which is logged too. */
WHIT_CHECK whit_result shader_annotations_read(const whit_log *log, whit_shader *shader,
                                               struct shader_errors *errors);

/* Reads a colour like #ffcc88; false: `text` is no such colour. */
bool shader_color_read(const char *text, float srgb[3]);

#endif

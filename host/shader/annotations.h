/* The lines `//@ ...` of files. */
#ifndef SHADER_ANNOTATIONS_H
#define SHADER_ANNOTATIONS_H

#include "shader/program.h"

/* The lines `//@ ...` of all files, into `shader`. WHIT_ERROR_INPUT, with what is
   wrong in `errors` and logged. */
WHIT_CHECK whit_result shader_annotations_read(const whit_log *log, whit_shader *shader,
                                               struct shader_errors *errors);

/* A colour as #ffcc88; false: it is none. */
bool shader_color_read(const char *text, float srgb[3]);

#endif

/* Replaces functions of GLSL that the driver or its caller would get wrong, wherever they stand:
   modf() writes through a pointer, which device/evaluate_memory.c does not follow, and lavapipe
   22.3 gives 0 for the upper half of unpackHalf2x16() of a constant. */
#ifndef SHADER_REPAIRS_H
#define SHADER_REPAIRS_H

#include "shader/module.h"

/* Rewrites an instruction of a function, before it would be copied. True: the result is in m->body.
   False: copy it as it is. */
bool repairs_take(struct spv_module *m, const uint32_t *words);

#endif

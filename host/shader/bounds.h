/* Keeps indices in a user's functions within bounds: each index that is computed goes through an
   unsigned minimum, so that -1 and 2^31 mean the last element. */
#ifndef SHADER_BOUNDS_H
#define SHADER_BOUNDS_H

#include "shader/module.h"

/* Rewrites an instruction of the user's code that has indices, before it would be copied. True: the
   result is in m->body. False: copy it as it is, or, with *why set, it is refused for this
   reason. */
bool bounds_take(struct spv_module *m, const uint32_t *words, const char **why);

#endif

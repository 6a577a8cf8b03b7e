/* Indices of users that stay within what they index: each that is computed goes through an unsigned
   minimum, so that -1 and 2^31 mean the last element. */
#ifndef SHADER_BOUNDS_H
#define SHADER_BOUNDS_H

#include "shader/module.h"

/* Takes an instruction of the user's, before it is copied. True: it stands in m->body already.
 *why: it cannot be kept within bounds, and this is why; else it is left alone. */
bool bounds_take(struct spv_module *m, const uint32_t *words, const char **why);

#endif

/* Rewrites returns inside of loops and switches of users: each sets a flag and leaves the construct
   at its merge block, after which the flag is tested. device/evaluate.h supports no other way out
   of a loop. */
#ifndef SHADER_RETURNS_H
#define SHADER_RETURNS_H

#include "shader/module.h"

/* Whether the end of a function with a result can be reached, from its OpFunction on: glslang
   returns an OpUndef there. No memory: m->failed. */
bool returns_lacks(struct spv_module *m, const uint32_t *function);
/* Gives the rewritten module, with its debug instructions. Free ->words; no words: no memory,
   m->failed. */
struct spv_words returns_rewrite(struct spv_module *m);

#endif

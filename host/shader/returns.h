/* Returns out of loops and switches of users become ways to the end of these, where a flag says
   that the function is left: what is evaluated (device/evaluate.h) has no other way out of a loop.
 */
#ifndef SHADER_RETURNS_H
#define SHADER_RETURNS_H

#include "shader/module.h"

/* The module with its remarks. Free ->words; no words: no memory, m->failed. */
struct spv_words returns_rewrite(struct spv_module *m);

#endif

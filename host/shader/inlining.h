/* Counts the instructions of functions as drivers do, which put a copy of a function in the place
   of each call: functions that call others twice, which call others twice, are as large as a text
   of macros that double. */
#ifndef SHADER_INLINING_H
#define SHADER_INLINING_H

#include "shader/module.h"

/* Instructions of all functions of a file, or of all its tests. */
enum { INLINING_MAX = 1 << 20 };

/* The first function that has more instructions than INLINING_MAX with all that it calls, while
   none that it calls has; NULL: there is none. */
const uint32_t *inlining_find_large(struct spv_module *m);

#endif

/* What of whit's the functions of a user come to call. */
#ifndef SHADER_REACH_H
#define SHADER_REACH_H

#include <stdint.h>

/* Bits SHADER_REACHES_* of a function that is called, by its name in a module. */
uint32_t reach_of(const char *name);

#endif

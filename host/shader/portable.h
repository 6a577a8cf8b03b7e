/* Makes a kernel portable: operations whose results Vulkan leaves to the driver are replaced by
   calls of functions of shaders/lib/portable.glsl, chosen by name and by types of arguments. */
#ifndef SHADER_PORTABLE_H
#define SHADER_PORTABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "shader/program.h"
#include "whit/whit_base.h"

struct portable_params {
    bool own_division;   /* the device rounds division and square root correctly */
    bool own_comparison; /* the device's comparisons and fabs distinguish denormals from 0 */
    /* Float controls that kernels declare, which the device must support: sums rounded to nearest;
       NaN, infinity and the sign of 0 kept; denormals kept. */
    bool asks_nearest, asks_special, asks_denormals;
    const whit_shader *shader; /* the user's functions in the kernel, for messages; may be NULL */
};

enum { PORTABLE_WHY_BYTES = 160 };

/* *out is malloc()ed. WHIT_ERROR_INPUT: `why` names an operation that has no such function, or says
   that the module is no kernel. All float operations are marked NoContraction (shader/exact.h).
   Several threads may call it at once. */
WHIT_CHECK whit_result shader_make_portable(const struct portable_params *params,
                                            const uint32_t *words, size_t word_count,
                                            uint32_t **out, size_t *out_words,
                                            char why[PORTABLE_WHY_BYTES]);

/* A number for the operation of an instruction that has no portable function for any arguments; 0:
   it has one, or needs none. */
uint32_t portable_lacks(const uint32_t *words);

#endif

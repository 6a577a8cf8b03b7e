/* A kernel in which nothing of what Vulkan leaves to the driver is left: functions of
   shaders/lib/portable.glsl stand in for it, chosen by name and by types of arguments. */
#ifndef SHADER_PORTABLE_H
#define SHADER_PORTABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "shader/program.h"
#include "whit/whit_base.h"

struct portable_params {
    bool own_division;   /* the device's own division and square root are rounded correctly */
    bool own_comparison; /* its comparisons and absolute values tell denormals from 0 */
    /* What kernels ask of the device, which has to offer it: sums rounded to nearest; NaN, infinity
       and the sign of 0 kept; denormals kept. */
    bool asks_nearest, asks_special, asks_denormals;
    const whit_shader *shader; /* with users' functions of the kernel, for messages; or NULL */
};

enum { PORTABLE_WHY_BYTES = 160 };

/* *out is malloc()ed. WHIT_ERROR_INPUT: `why` names what has no such function, or says that it is
   no kernel. Float operations are marked NoContraction, all of them (shader/exact.h). Several
   threads may call it at once. */
WHIT_CHECK whit_result shader_make_portable(const struct portable_params *params,
                                            const uint32_t *words, size_t word_count,
                                            uint32_t **out, size_t *out_words,
                                            char why[PORTABLE_WHY_BYTES]);

/* Which operation without such a function, whatever its arguments, an instruction is, as a number;
   0: none. */
uint32_t portable_lacks(const uint32_t *words);

#endif

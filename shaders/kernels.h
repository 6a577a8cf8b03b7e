/* SPIR-V of the kernels, embedded at build. */
#ifndef SHADERS_KERNELS_H
#define SHADERS_KERNELS_H

#include <stddef.h>
#include <stdint.h>

enum kernel {
    KERNEL_TRACE,
    KERNEL_CLOSEST,
    KERNEL_SHADE,
    KERNEL_SHADOW,
    KERNEL_RESOLVE,
    KERNEL_COUNT
};

struct kernel_code {
    const char *name;
    const uint32_t *words;
    size_t bytes;
};

extern const struct kernel_code kernels[KERNEL_COUNT];

/* Kernels with room for functions of users, in the order of HOOK_KERNEL of hook/prelude.glsl: with
   the names of all functions, and those that nothing calls, for host/shader/link.c. */
enum hook_kernel {
    HOOK_KERNEL_CLOSEST,
    HOOK_KERNEL_SHADE,
    HOOK_KERNEL_SHADOW,
    HOOK_KERNEL_RESOLVE, /* without room */
    HOOK_KERNEL_MISS,    /* of a user's function alone */
    HOOK_KERNEL_SHAPE,   /* likewise */
    HOOK_KERNEL_HIT,     /* likewise */
    HOOK_KERNEL_AOV,     /* likewise */
    HOOK_KERNEL_POST,    /* likewise */
    HOOK_KERNEL_TEST,    /* runs tests of the user's file */
    HOOK_KERNEL_COUNT
};

extern const struct kernel_code hook_kernels[HOOK_KERNEL_COUNT];

/* The functions of lib/portable.glsl with their names, all of them, and an entry point that answers
   one for cases in a buffer (abi/portable.h). */
extern const struct kernel_code portable_kernel;

#endif

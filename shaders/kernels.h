/* SPIR-V of the kernels, embedded at build. */
#ifndef SHADERS_KERNELS_H
#define SHADERS_KERNELS_H

#include <stddef.h>
#include <stdint.h>

enum {
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

/* Kernels into which host/shader/link.c puts functions of users, in the order of HOOK_KERNEL of
   hook/prelude.glsl. They keep the names of all functions, and those that nothing calls. */
enum hook_kernel {
    HOOK_KERNEL_CLOSEST,
    HOOK_KERNEL_SHADE,
    HOOK_KERNEL_SHADOW,
    HOOK_KERNEL_RESOLVE, /* takes no functions: whit's own kernel is used */
    HOOK_KERNEL_MISS,    /* used with a user's function only */
    HOOK_KERNEL_SHAPE,   /* the same */
    HOOK_KERNEL_HIT,     /* the same */
    HOOK_KERNEL_AOV,     /* the same */
    HOOK_KERNEL_POST,    /* the same */
    HOOK_KERNEL_TEST,    /* runs tests of the user's file */
    HOOK_KERNEL_COUNT
};

extern const struct kernel_code hook_kernels[HOOK_KERNEL_COUNT];

/* All functions of lib/portable.glsl with their names, and an entry point that computes one of them
   for cases in a buffer (abi/portable.h). */
extern const struct kernel_code portable_kernel;

#endif

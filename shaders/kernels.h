/* SPIR-V of the kernels, embedded at build. */
#ifndef SHADERS_KERNELS_H
#define SHADERS_KERNELS_H

#include <stddef.h>
#include <stdint.h>

enum kernel {
    KERNEL_TRACE,
    KERNEL_PRESENT,
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

#endif

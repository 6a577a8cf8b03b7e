/* Functions of a user in a stage's kernel: their module, which was compiled for itself, and the
   kernel's become one. */
#ifndef SHADER_LINK_H
#define SHADER_LINK_H

#include "shader/module.h"

/* `user`: the SPIR-V of kernel/hook.comp with its debug instructions, as functions are found by
   name. `own`: how names of whit's own files begin. Functions of hook/interface.glsl become those
   of the same name in the kernel, and functions of the kernel that the user has as well become the
   user's. What nothing calls is left out. Free ->words. No words: *why says why, or is NULL where
   there is no memory. */
struct spv_words link_kernel(const uint32_t *kernel, size_t kernel_words, const uint32_t *user,
                             size_t count, const char *own, const char **why);

#endif

/* Links a user's functions into the kernel of a stage: the module of the functions, which was
   compiled separately, and the kernel become one module. */
#ifndef SHADER_LINK_H
#define SHADER_LINK_H

#include "shader/module.h"

/* `user`: the SPIR-V of kernel/hook.comp with its debug instructions, as functions are found by
   name. `own`: the start of names of whit's own files. Functions of hook/interface.glsl are
   replaced by those of the same name in the kernel, and functions of the kernel that the user has
   too by the user's. Functions that nothing calls are left out. Free ->words. No words: *why is the
   reason, or NULL if there is no memory. */
struct spv_words link_kernel(const uint32_t *kernel, size_t kernel_words, const uint32_t *user,
                             size_t count, const char *own, const char **why);

/* Whether a function is a hook, by its name in GLSL or as glslang writes it ("miss(vf3;"). */
bool link_is_hook(const char *name);

#endif

/* Compiles GLSL with a user's functions. A process is kept for that, since glslang needs about 100
   ms before its first kernel; for each request it forks a sandboxed child. */
#ifndef SHADER_COMPILE_H
#define SHADER_COMPILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/child.h"
#include "shader/stages.h"
#include "shader/text.h"
#include "whit/whit_shader.h"

struct shader_request {
    const char *kernel; /* path of an embedded file below shaders/, as "kernel/shade.comp" */
    /* A kernel's text in place of the embedded one. It may include embedded files, by names
       relative to `kernel`. NULL: the embedded text. */
    const char *kernel_text;
    const char *declared;       /* GLSL in front of the user's text; NULL: none */
    const char *const *defines; /* "NAME" or "NAME VALUE", as #define lines after #extension */
    uint32_t define_count;
    /* Used in place of the embedded files; NULL: the embedded files are used. */
    const struct shader_stages *stages;
    bool trust; /* no fuel for loops, no bounds for indices */
    /* Keeps names, and functions that nothing calls: the result will be a `base`. */
    bool names;
    /* The kernel that functions of kernel/hook.comp are linked into (link.h); it was made with
       `names`. NULL: `kernel` is complete. */
    const uint32_t *base;
    size_t base_bytes;
    double cpu_s; /* processor time, if whit_shader_limits has none; 0: 5 */
};

/* The place where a loop of the user's text begins. */
struct shader_loop {
    uint32_t file; /* index in shader_text.files */
    uint32_t line;
};

/* An operation in the user's code that has no portable form (portable.h), and the first place where
   it is used. */
struct shader_open {
    uint32_t number; /* result of portable_lacks; 0: none */
    uint32_t file, line;
};

enum { SHADER_OPENS_MAX = 8 }; /* places of further operations are not kept */

/* Bits for the functions of whit's own that a user's functions call, and for the parts of a surface
   and its material that they read. Where a bit is not set, the thing that it stands for cannot
   change their results. */
enum {
    SHADER_REACHES_LIGHTS = 1,  /* lights of the scene */
    SHADER_REACHES_SHADOWS = 2, /* shadows: what blocks the way to a point */
    SHADER_REACHES_RAYS = 4,    /* rays that the user's functions trace */
    SHADER_REACHES_TEXTURES = 8,
    SHADER_REACHES_VERTEX_COLORS = 16,
    SHADER_REACHES_METAL_ROUGH = 32, /* whether a material is metal-rough */
    SHADER_REACHES_EMISSION = 64,
    SHADER_REACHES_HIGHLIGHTS = 128,
    SHADER_REACHES_NORMALS = 256, /* shading normals: smooth normals and normal maps */
    SHADER_REACHES_SHARES = 512,  /* shares of light that is reflected or let through */
    SHADER_REACHES_ALL = 1023
};

/* A compiled kernel. whit_fuel_loop holds 1 + the index in `loops`. */
struct shader_code {
    uint32_t *words; /* SPIR-V 1.5 without debug information; float operations are NoContraction */
    size_t bytes;
    struct shader_loop *loops; /* none with `trust`, or if the kernel declares no whit_fuel */
    uint32_t loop_count;
    uint32_t instructions; /* number of instructions in all functions */
    uint32_t reaches;      /* bits SHADER_REACHES_* */
    struct shader_open opens[SHADER_OPENS_MAX];
};

struct shader_compiler;

/* Forks the process that is kept. The fork shares the caller's memory, copied page by page when one
   of them writes: best called before scenes are loaded. It ends with the caller. If it cannot be
   started, each request is compiled in a process of its own, slower. NULL: no memory. `log` is
   kept. `limits`, which may be NULL, and `clock_s`, elapsed time (0: 20), are those of one request.
   Used by one thread at a time. */
struct shader_compiler *shader_compiler_create(const whit_log *log,
                                               const whit_shader_limits *limits, double clock_s);
void shader_compiler_destroy(struct shader_compiler *compiler); /* NULL is fine */

/* Compiles a kernel with the user's text in place of hook/user.glsl, which stays if `text` is NULL
   or empty. WHIT_ERROR_INPUT: what is wrong (also, that there is no such kernel) is in `errors`
   (may be NULL) and logged, each as "FILE:line: reason". WHIT_ERROR_MEMORY, _CANCELLED, _USAGE (a
   sandbox is required but not available). *code is zeroed after an error; free it by
   shader_code_free. */
WHIT_CHECK whit_result shader_compile(struct shader_compiler *compiler,
                                      const struct shader_text *text,
                                      const struct shader_request *request,
                                      struct shader_code *code, struct shader_errors *errors);
void shader_code_free(struct shader_code *code); /* accepts a zeroed one */

#endif

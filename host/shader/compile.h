/* The compiler of GLSL with functions of users in it: a process that is kept, since glslang takes
   about 100 ms before its first kernel, and forks for each request a child that is locked in. */
#ifndef SHADER_COMPILE_H
#define SHADER_COMPILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/child.h"
#include "shader/stages.h"
#include "shader/text.h"

/* One request may use this much. A zeroed struct means the defaults. */
struct shader_limits {
    double cpu_s;                /* of the processor; 0: as the request says */
    double clock_s;              /* 0: 20 */
    uint64_t memory_bytes;       /* 0: 1 GiB */
    bool require_sandbox;        /* where it cannot be set: an error in place of a warning */
    const volatile bool *cancel; /* polled while a request is under way; may be NULL */
};

struct shader_request {
    const char *kernel; /* a file below shaders/, "kernel/shade.comp", of those embedded */
    /* In place of the embedded one, a kernel's own text, which may include what is embedded by
       names relative to `kernel`; NULL: none. */
    const char *kernel_text;
    const char *const *defines; /* "NAME" or "NAME VALUE": #define lines behind the extensions */
    uint32_t define_count;
    const struct shader_stages *stages; /* in place of what is embedded; NULL: that */
    bool trust;                         /* the user's loops and indices are left as they are */
    bool names; /* keeps names, and functions that nothing calls: what is made is to be a `base` */
    /* The kernel that functions of kernel/hook.comp go into, made with `names` (link.h); NULL:
       `kernel` is whole. */
    const uint32_t *base;
    size_t base_bytes;
    double cpu_s; /* of the processor, where shader_limits say none; 0: 5 */
};

/* Where a loop of the user's text begins. */
struct shader_loop {
    uint32_t file; /* index in shader_text.files */
    uint32_t line;
};

/* An operation in the user's code that has no portable form (portable.h), and where it stands
   first. */
struct shader_open {
    uint32_t number; /* of portable_lacks; 0: none */
    uint32_t file, line;
};

enum { SHADER_OPENS_MAX = 8 }; /* of others the place is not known */

/* Which functions of whit's a user's functions call, and which parts of a surface and its material
   they read. What a bit stands for changes nothing of what they give where the bit is not set. */
enum {
    SHADER_REACHES_LIGHTS = 1,  /* lights of the scene */
    SHADER_REACHES_SHADOWS = 2, /* what is on the way to a place */
    SHADER_REACHES_RAYS = 4,    /* rays of their own */
    SHADER_REACHES_TEXTURES = 8,
    SHADER_REACHES_VERTEX_COLORS = 16,
    SHADER_REACHES_METAL_ROUGH = 32, /* whether a material is */
    SHADER_REACHES_EMISSION = 64,
    SHADER_REACHES_HIGHLIGHTS = 128,
    SHADER_REACHES_NORMALS = 256, /* of shading: smooth ones and normal maps */
    SHADER_REACHES_SHARES = 512,  /* of light that is mirrored or let through */
    SHADER_REACHES_ALL = 1023
};

/* What whit_fuel_loop holds is 1 + the index in `loops`. */
struct shader_code {
    uint32_t *words; /* SPIR-V 1.5 without debug information; float operations are NoContraction */
    size_t bytes;
    struct shader_loop *loops; /* none with `trust`, or where the kernel declares no whit_fuel */
    uint32_t loop_count;
    uint32_t instructions; /* in all functions */
    uint32_t reaches;      /* bits SHADER_REACHES_* */
    struct shader_open opens[SHADER_OPENS_MAX];
};

struct shader_compiler;

/* Forks the process that is kept. The fork has the memory of the caller as it then is, page by page
   until one of them writes to it: best called before scenes are loaded. It ends with the caller. A
   compiler whose process cannot be had compiles each request in a process of its own, slower. NULL:
   no memory. `log` is kept. Used by one thread at a time. */
struct shader_compiler *shader_compiler_create(const whit_log *log,
                                               const struct shader_limits *limits);
void shader_compiler_destroy(struct shader_compiler *compiler); /* NULL is fine */

/* Compiles a kernel with the user's text in the place of hook/user.glsl; NULL or an empty `text`
   leaves that as it is. WHIT_ERROR_INPUT: what is wrong is in `errors` (may be NULL) and logged,
   each as "FILE:line: reason". WHIT_ERROR_MEMORY, _CANCELLED, _USAGE (sandbox required and not to
   be had, or no such kernel). *code, zeroed but for WHIT_OK, is given back by shader_code_free. */
WHIT_CHECK whit_result shader_compile(struct shader_compiler *compiler,
                                      const struct shader_text *text,
                                      const struct shader_request *request,
                                      struct shader_code *code, struct shader_errors *errors);
void shader_code_free(struct shader_code *code); /* accepts a zeroed one */

/* The text that shader_compile compiles, for who wants to look at it; free() it. NULL: no memory,
   no such kernel, or too much text, which is logged and added to `errors`. */
char *shader_expand(const whit_log *log, const struct shader_text *text,
                    const struct shader_request *request, size_t *bytes,
                    struct shader_errors *errors);

#endif

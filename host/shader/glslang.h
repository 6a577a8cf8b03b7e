/* Compiles the text of one kernel to SPIR-V by glslang. This runs in a sandboxed child. */
#ifndef SHADER_GLSLANG_H
#define SHADER_GLSLANG_H

#include "base/child.h"
#include "shader/compile.h"

enum { GLSLANG_OWN_BYTES = 32 };

struct glslang_question {
    const char *text; /* ends with a 0 */
    size_t bytes;
    size_t user_at, user_end;    /* the user's part of `text`; equal: there is none */
    char own[GLSLANG_OWN_BYTES]; /* tag of whit's own files, see expand.h */
    bool trust;
    bool names;           /* shader_request.names */
    const uint32_t *base; /* shader_request.base */
    size_t base_words;
};

/* An error as the child reports it, which is not trusted. */
struct glslang_error {
    uint32_t own; /* 0: `file` is the user's, 1: whit's own, 2: no file */
    uint32_t file, line;
    char reason[SHADER_REASON_BYTES];
};

/* The reply: this struct, then the SPIR-V words, then the loops. Without words there is at least
   one error. */
struct glslang_answer {
    struct glslang_error errors[SHADER_ERROR_MAX];
    uint32_t error_count, more;
    uint64_t word_count;
    uint32_t loop_count, instructions, reaches;
    struct shader_open opens[SHADER_OPENS_MAX];
};

/* Does what takes glslang long once in a process; optional. Called in the process that is then
   forked for requests. */
void glslang_warm(void);
/* A function for child_run: `user` is a glslang_question. Returns 0, CHILD_EXIT_MEMORY or 1 (the
   reply could not be written). */
int glslang_answer_question(void *user, void *to, child_write write);

#endif

/* One kernel's text to SPIR-V, by glslang: what runs in a child, locked in. */
#ifndef SHADER_GLSLANG_H
#define SHADER_GLSLANG_H

#include "base/child.h"
#include "shader/compile.h"

enum { GLSLANG_OWN_BYTES = 32 };

struct glslang_question {
    const char *text; /* ends with a 0 */
    size_t bytes;
    size_t user_at, user_end;    /* where the user's part of it is; the same: there is none */
    char own[GLSLANG_OWN_BYTES]; /* see expand.h */
    bool trust;
    bool names;           /* shader_request.names */
    const uint32_t *base; /* NULL: there is none */
    size_t base_words;
};

/* An error as a child tells it; not to be believed but for its size. */
struct glslang_error {
    uint32_t own; /* 0: `file` is one of the user's, 1: one of whit's, 2: nobody's */
    uint32_t file, line;
    char reason[SHADER_REASON_BYTES];
};

/* The reply: this, then the words, then the loops. Without words there is at least one error. */
struct glslang_answer {
    struct glslang_error errors[SHADER_ERROR_MAX];
    uint32_t error_count, more;
    uint64_t word_count;
    uint32_t loop_count, instructions, reaches;
    struct shader_open opens[SHADER_OPENS_MAX];
};

/* What glslang takes long for once in a process. Called by what is then forked, or not at all. */
void glslang_warm(void);
/* For child_run: `user` is a glslang_question. 0, or CHILD_EXIT_MEMORY. */
int glslang_answer_question(void *user, void *to, child_write write);

#endif

/* A kernel with all that it includes, and the user's text, in one text. */
#ifndef SHADER_EXPAND_H
#define SHADER_EXPAND_H

#include "shader/compile.h"

/* Files in #line directives are called USER_TAG and their number, or `own` and theirs: an index in
   shader_sources or the request's stages, or their count for a text of the request. A user who
   could guess `own` could pass for whit. */
#define EXPAND_USER_TAG "user."

struct expanded {
    char *text; /* malloc'ed; ends with a 0 that `bytes` does not count */
    size_t bytes;
    size_t user_at, user_end; /* where the user's part is; the same: there is none */
};

enum { EXPAND_NAME_BYTES = 256 };
/* What a line of whit's own text includes, behind its quote; the length of that, 0: nothing. */
size_t expand_included(const char *line, const char **name);
/* "../bind/x.glsl" or "x.glsl", as "kernel/y.comp" names it. */
void expand_join(const char *from, const char *name, size_t length, char out[EXPAND_NAME_BYTES]);

/* False: why not was told. */
bool expand_kernel(const whit_log *log, const struct shader_text *text,
                   const struct shader_request *request, const char *own, struct expanded *expanded,
                   struct shader_errors *errors);

#endif

/* A kernel with all that it includes, and the user's text, in one text. */
#ifndef SHADER_EXPAND_H
#define SHADER_EXPAND_H

#include "shader/compile.h"

/* Files in #line directives are called USER_TAG and their number, or `own` and theirs: an index in
   shader_sources, or shader_source_count for a text of the request. A user who could guess `own`
   could pass for whit. */
#define EXPAND_USER_TAG "user."

struct expanded {
    char *text; /* malloc'ed; ends with a 0 that `bytes` does not count */
    size_t bytes;
    size_t user_at, user_end; /* where the user's part is; the same: there is none */
};

/* False: why not was told. */
bool expand_kernel(const whit_log *log, const struct shader_text *text,
                   const struct shader_request *request, const char *own, struct expanded *expanded,
                   struct shader_errors *errors);

#endif

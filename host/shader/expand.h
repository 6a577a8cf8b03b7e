/* Expands a kernel to one text, with all that it includes and the user's text. */
#ifndef SHADER_EXPAND_H
#define SHADER_EXPAND_H

#include "shader/compile.h"

/* Names of files in #line directives: for the user's files EXPAND_USER_TAG and the file's index;
   for others the tag `own` and an index in shader_sources or the request's stages (for kernel_text:
   their count). `own` is random, so that a user's text cannot pretend to be whit's. */
#define EXPAND_USER_TAG "user."

struct expanded {
    char *text; /* malloc'ed; ends with a 0 that `bytes` does not count */
    size_t bytes;
    size_t user_at, user_end; /* range of the user's part of `text`; equal: no such part */
};

enum { EXPAND_NAME_BYTES = 256 };
/* The name that a line of whit's own text includes: returns its length; 0: the line includes
   nothing. */
size_t expand_included(const char *line, const char **name);
/* Joins the path of the including file, as "kernel/y.comp", and a name such as "../bind/x.glsl" or
   "x.glsl". */
void expand_join(const char *from, const char *name, size_t length, char out[EXPAND_NAME_BYTES]);

/* The text that the compiler gets. WHIT_ERROR_MEMORY, or _INPUT (no such kernel, one without a
   place for `text`, or too much text, which `errors` has too): it was logged, and *expanded is
   empty. */
WHIT_CHECK whit_result expand_kernel(const whit_log *log, const struct shader_text *text,
                                     const struct shader_request *request, const char *own,
                                     struct expanded *expanded, struct shader_errors *errors);

#endif

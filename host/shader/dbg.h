/* dbg(x) in a user's file: a value that is shown for one pixel. In kernels of pictures only x is
   left; kernels of a probed pixel record the value. */
#ifndef SHADER_DBG_H
#define SHADER_DBG_H

#include "shader/tests.h"
#include "shader/text.h"

enum {
    SHADER_DBG_MAX = 64 /* calls in all files: DBG_CALLS of abi/shade.h */,
    SHADER_DBG_BYTES = 96
};

/* A dbg(x) in the text. */
struct shader_dbg_site {
    char text[SHADER_DBG_BYTES]; /* source text of x, with single blanks; cut if it is long */
    uint32_t file, line;
    size_t word, at; /* byte offsets in the file: of the word dbg, and of x */
};

/* All dbg(x) of a user's files, in the order of files and of text in them. */
struct shader_dbg {
    struct shader_dbg_site sites[SHADER_DBG_MAX];
    uint32_t count;
};

/* Finds all dbg(x); none if a file defines a function dbg() of its own. WHIT_ERROR_INPUT, with the
   reasons in `errors` (may be NULL) and logged: a call outside of a function, in a macro or in a
   test, with other than one value, or more calls than the limit. */
WHIT_CHECK whit_result shader_dbg_read(const whit_log *log, const struct shader_text *text,
                                       const struct shader_tests *tests, struct shader_dbg *dbg,
                                       struct shader_errors *errors);

/* Copies the text with each word dbg replaced by blanks, so that x is left, or with `numbered` with
   the call's number before x. Lines keep their numbers; without `numbered` bytes keep their
   offsets. The files are those that shader_dbg_read saw, or as long. Free it by
   shader_text_end_copy; false: no memory. */
bool shader_dbg_text(const struct shader_dbg *dbg, const struct shader_text *text, bool numbered,
                     struct shader_text *out);

#endif

/* dbg(x) in a user's file: a value that is shown for one pixel. Kernels of pictures have x alone in
   its place; those of a pixel that is looked at record what x is. */
#ifndef SHADER_DBG_H
#define SHADER_DBG_H

#include "shader/tests.h"
#include "shader/text.h"

enum {
    SHADER_DBG_MAX = 64 /* calls in all files: DBG_SITES of abi/shade.h */,
    SHADER_DBG_BYTES = 96
};

/* A call in the text. */
struct shader_dbg_site {
    char text[SHADER_DBG_BYTES]; /* x as it stands there, blanks as one; cut where it is long */
    uint32_t file, line;
    size_t word, at; /* offsets in the file: of the word dbg, and of what follows its bracket */
};

/* In the order of files, lines and what stands on them. */
struct shader_dbg {
    struct shader_dbg_site sites[SHADER_DBG_MAX];
    uint32_t count;
};

/* Finds the calls of all files; in a file that has a function dbg() of its own there is none.
   WHIT_ERROR_INPUT, with what is wrong in `errors` (may be NULL) and logged: a call outside of a
   function, in a macro or in a test, of other than one value, or more than the limit. */
WHIT_CHECK whit_result shader_dbg_read(const whit_log *log, const struct shader_text *text,
                                       const struct shader_tests *tests, struct shader_dbg *dbg,
                                       struct shader_errors *errors);

/* The text with the names of the calls blank, so that x is left, or with `numbered` the call's
   number in front of x. Lines stay where they are, and without `numbered` bytes do too. The files
   are those that shader_dbg_read saw, or as long. Freed by shader_text_end_copy; false: no memory.
 */
bool shader_dbg_text(const struct shader_dbg *dbg, const struct shader_text *text, bool numbered,
                     struct shader_text *out);

#endif

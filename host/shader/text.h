/* The text of a user's functions: a file with all that it includes. */
#ifndef SHADER_TEXT_H
#define SHADER_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "shader/errors.h"

enum {
    SHADER_TEXT_FILES_MAX = 64,
    SHADER_TEXT_DEPTH_MAX = 16,       /* depth of includes, with the first file */
    SHADER_TEXT_FILE_BYTES = 1 << 20, /* of a file */
    SHADER_TEXT_LINE_BYTES = 1 << 16  /* of a line; longer ones may overflow glslang's stack */
};

/* An `#include "x"` in a file. */
struct shader_include {
    uint32_t line; /* from 1 */
    uint32_t file; /* index in files[] */
};

struct shader_file {
    char *name; /* for messages: path from where whit was started */
    /* Path from the folder of the first file, without "." and ".."; for files[0] its name. */
    char *relative;
    /* The text that is compiled: without a byte order mark, a CR alone as a line's end, and without
       what `#if 0` leaves out; it ends with a 0 that `bytes` does not count. `raw`: the file's own
       bytes, as many. */
    char *text, *raw;
    size_t bytes;
    struct shader_include *includes; /* in the order of their lines */
    uint32_t include_count, include_capacity;
};

/* files[0] is the file that the user named; the others follow in the order in which they are first
   included. */
struct shader_text {
    struct shader_file *files;
    uint32_t file_count, file_capacity;
};

/* Reads `path` and what it includes: regular files below the folder of `path`, links resolved.
   Errors that name the include and its line: a file that is missing, outside, not regular, or over
   the limits; a file that includes itself. Errors that name the file and line: bytes 0 and others
   that are no text, characters beyond ASCII outside of comments and strings, #version, #extension,
   #line, a comment or an #if without end, an #endif too many. WHIT_ERROR_INPUT, _MEMORY; *text is
   then empty. `errors` may be NULL. Free it by shader_text_free. */
WHIT_CHECK whit_result shader_text_read(const whit_log *log, const char *path,
                                        struct shader_text *text, struct shader_errors *errors);

/* The same for texts in memory, as a picture's recipe has them. `relative` as in struct
   shader_file; the first source is the file that the user named. Includes are resolved among the
   sources. */
struct shader_text_source {
    const char *relative;
    const char *text;
    size_t bytes;
};
WHIT_CHECK whit_result shader_text_from(const whit_log *log,
                                        const struct shader_text_source *sources, uint32_t count,
                                        struct shader_text *text, struct shader_errors *errors);

/* *text may be zeroed. */
void shader_text_free(struct shader_text *text);

/* Copies a text: each file's text is copied, with room for `more` bytes; everything else is
   borrowed. The text may have no files. False: no memory, and *out is empty. */
bool shader_text_copy(const struct shader_text *text, size_t more, struct shader_text *out);
void shader_text_end_copy(struct shader_text *copy); /* accepts a zeroed one */

/* Whether any of the files has a function of this name with a body at the top level;
   *file and *line (may be NULL): the first of them. The text is not preprocessed: code in a false
   #if counts, but for `#if 0`, and code that macros make does not. */
bool shader_text_defines(const struct shader_text *text, const char *name, uint32_t *file,
                         uint32_t *line);

/* A hash of all files' own bytes, their names and their order. */
uint64_t shader_text_hash(const struct shader_text *text);

#endif

/* The text of a user's functions: a file with all that it includes, read once. */
#ifndef SHADER_TEXT_H
#define SHADER_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "shader/errors.h"

enum {
    SHADER_TEXT_FILES_MAX = 64,
    SHADER_TEXT_DEPTH_MAX = 16,       /* files that are open at once, the first one too */
    SHADER_TEXT_FILE_BYTES = 1 << 20, /* of one file */
    SHADER_TEXT_LINE_BYTES =
        1 << 16 /* of one line: what is in longer ones is deeper than glslang's stack */
};

/* `#include "x"` on a line of a file. */
struct shader_include {
    uint32_t line; /* from 1 */
    uint32_t file; /* index in files[] */
};

struct shader_file {
    char *name; /* for messages: as the user can open it from where whit was started */
    char
        *relative; /* from the folder of the first file, without "." and ".."; files[0]: its name */
    char *text;    /* ends with a 0 that `bytes` does not count */
    size_t bytes;
    struct shader_include *includes; /* in the order of lines */
    uint32_t include_count, include_capacity;
};

/* files[0] is what the user named; the others follow in the order of their first #include. */
struct shader_text {
    struct shader_file *files;
    uint32_t file_count, file_capacity;
};

/* Reads `path` and what it includes. Of included names those are followed that lead to regular
   files below the folder of `path`, links resolved. Refused by name, with the line of the include:
   what is missing, outside, no file, over the limits, a file that includes itself. Refused by name
   and line: bytes 0 and other than text, #version, #extension, #line, a comment or an #if without
   end, an #endif too many. A file without anything in it is refused. WHIT_ERROR_INPUT, _MEMORY;
   *text is then empty. `errors` may be NULL. Ended by shader_text_free. */
WHIT_CHECK whit_result shader_text_read(const whit_log *log, const char *path,
                                        struct shader_text *text, struct shader_errors *errors);

/* The same of texts in memory, as a recipe keeps them. `relative` as in struct shader_file, the
   first one is the user's; includes are resolved among them. */
struct shader_text_source {
    const char *relative;
    const char *text;
    size_t bytes;
};
WHIT_CHECK whit_result shader_text_from(const whit_log *log,
                                        const struct shader_text_source *sources, uint32_t count,
                                        struct shader_text *text, struct shader_errors *errors);

/* Accepts a zeroed one. */
void shader_text_free(struct shader_text *text);

/* A text with files' texts of its own, which have room for `more` bytes; it borrows the rest.
   Accepts no file. False: no memory, and *out is empty. */
bool shader_text_copy(const struct shader_text *text, size_t more, struct shader_text *out);
void shader_text_end_copy(struct shader_text *copy); /* accepts a zeroed one */

/* Whether a function of this name has a body at the top level of the text, in any of the files;
   *file and *line, which may be NULL, say where the first is. Reads the text as it stands: what #if
   leaves out counts, what macros make does not. */
bool shader_text_defines(const struct shader_text *text, const char *name, uint32_t *file,
                         uint32_t *line);

/* One number of all files, their names and order. */
uint64_t shader_text_hash(const struct shader_text *text);

#endif

/* The files of a user's functions in one text, as saved pictures contain them:

       \whit 1
       \file toon.glsl
       ...
       \file part/noise.glsl
       ...
       \end 0123456789abcdef

   Printable ASCII, line ends and tabs stand for themselves. A backslash is doubled, and any other
   byte is \x and two hexadecimal digits, so that nothing in a file looks like a line of the pack.
   The number behind \end is shader_text_hash. */
#ifndef SHADER_PACK_H
#define SHADER_PACK_H

#include "shader/text.h"

enum { SHADER_PACK_BYTES = 1 << 20, SHADER_PACK_NAME_BYTES = 512 };

/* Packs a text; free() the result. NULL, with *why: it would be larger than SHADER_PACK_BYTES, a
   file has a name that shader_pack_read refuses, or there is no memory. */
char *shader_pack_write(const struct shader_text *text, const char **why);

struct shader_pack {
    struct shader_text_source sources[SHADER_TEXT_FILES_MAX]; /* the first: the user named it */
    uint32_t count;
    char *bytes; /* the names and texts that `sources` points to */
};

/* Unpacks a text. WHIT_ERROR_INPUT or WHIT_ERROR_MEMORY: one message is logged, which begins with
   `where`, and *pack is empty. Names are relative and stay below a folder
   (shader_pack_name_refused); each occurs once, and none is a folder of another. Free it by
   shader_pack_free. */
WHIT_CHECK whit_result shader_pack_read(const whit_log *log, const char *where, const char *packed,
                                        struct shader_pack *pack);
void shader_pack_free(struct shader_pack *pack); /* accepts a zeroed one */

/* Why a file may not have this name; NULL: it may. Refused are absolute names, ".", "..", names of
   devices of any system, and characters that shells or other systems treat specially. */
const char *shader_pack_name_refused(const char *name);

#endif

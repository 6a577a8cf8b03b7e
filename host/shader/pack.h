/* The files of a user's functions in one text, as pictures carry them:

       \whit 1
       \file toon.glsl
       ...
       \file part/noise.glsl
       ...
       \end 0123456789abcdef

   Printable ASCII, line ends and tabs stand for themselves, a backslash is two, any other byte is
   \x and two digits: what a file holds is never taken for a line of the pack. The number is that of
   shader_text_hash. */
#ifndef SHADER_PACK_H
#define SHADER_PACK_H

#include "shader/text.h"

enum { SHADER_PACK_BYTES = 1 << 20, SHADER_PACK_NAME_BYTES = 512 };

/* free() it. NULL, with *why: it would be larger than SHADER_PACK_BYTES, a file has a name that
   shader_pack_read refuses, or there is no memory. */
char *shader_pack_write(const struct shader_text *text, const char **why);

struct shader_pack {
    struct shader_text_source sources[SHADER_TEXT_FILES_MAX]; /* the first is the user's */
    uint32_t count;
    char *bytes; /* of names and texts */
};

/* `where` begins the one message of what is wrong: WHIT_ERROR_INPUT, or WHIT_ERROR_MEMORY; *pack is
   then empty. Names are relative and stay below a folder (shader_pack_name_refused), each is there
   once, and none is a folder of another. Ended by shader_pack_free. */
WHIT_CHECK whit_result shader_pack_read(const whit_log *log, const char *where, const char *packed,
                                        struct shader_pack *pack);
void shader_pack_free(struct shader_pack *pack); /* accepts a zeroed one */

/* Why no file may be called so; NULL: it may. Absolute names, ".", "..", names of devices of any
   system, and characters that shells or other systems read as more than a letter are refused. */
const char *shader_pack_name_refused(const char *name);

#endif

/* Errors in a user's functions, with their places: for a log, and for a window. */
#ifndef SHADER_ERRORS_H
#define SHADER_ERRORS_H

#include <stdint.h>

#include "base/log.h"

enum { SHADER_ERROR_MAX = 32, SHADER_FILE_BYTES = 512, SHADER_REASON_BYTES = 512 };

/* `file` and `reason` are UTF-8 or foreign bytes, ended by 0, without line ends: show them by
   whit_text_show, as the log does. */
struct shader_error {
    char file[SHADER_FILE_BYTES]; /* as shader_file.name; a file of whit's own: "whit:lib/x.glsl" */
    uint32_t line;                /* from 1; 0: the file as a whole */
    uint32_t column;              /* from 1, in bytes; 0: not known */
    char reason[SHADER_REASON_BYTES];
};

/* The first SHADER_ERROR_MAX errors, in the order of the text. Zero it before its first use. */
struct shader_errors {
    struct shader_error items[SHADER_ERROR_MAX];
    uint32_t count;
    uint32_t more; /* number of further errors that are known */
};

/* Keeps an error and logs it as "FILE:line:column: reason", or without what is 0. Of the errors
   behind the first SHADER_ERROR_MAX it only logs that there are some. `errors` may be NULL. */
void shader_error_add(const whit_log *log, struct shader_errors *errors, const char *file,
                      uint32_t line, uint32_t column, const char *format, ...) WHIT_PRINTF(6, 7);

#endif

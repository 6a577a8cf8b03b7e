#include "shader/errors.h"

#include "base/text.h"
#include <stdarg.h>
#include <stdio.h>

void shader_error_add(const whit_log *log, struct shader_errors *errors, const char *file,
                      uint32_t line, uint32_t column, const char *format, ...)
{
    struct shader_error error = {.line = line, .column = column};
    snprintf(error.file, sizeof error.file, "%s", file);
    va_list args;
    va_start(args, format);
    text_print(error.reason, sizeof error.reason, format, args);
    va_end(args);
    if (errors && errors->count == SHADER_ERROR_MAX) {
        if (!errors->more++)
            log_error(log, "%s: there are more errors", error.file);
        return;
    }
    if (column)
        log_error(log, "%s:%u:%u: %s", error.file, line, column, error.reason);
    else if (line)
        log_error(log, "%s:%u: %s", error.file, line, error.reason);
    else
        log_error(log, "%s: %s", error.file, error.reason);
    if (errors)
        errors->items[errors->count++] = error;
}

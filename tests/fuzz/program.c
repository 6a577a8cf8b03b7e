/* Stands for the functions of the program that sources of app/ call, for targets that read options
   as it does. Errors are counted as those of the library are. */
#include <stdarg.h>
#include <stdio.h>

#include "app/cli.h"
#include "fuzz.h"

const whit_log cli_log = {0};

void cli_error(const char *format, ...)
{
    char text[1024];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    log_error(&fuzz_log, "%s", text);
}

void cli_set_saving(void) {}

int cli_finish_stdout(int status)
{
    return status;
}

bool cli_can_write(const char *path)
{
    return *path != '\0';
}

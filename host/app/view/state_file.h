/* Files of settings: options as on the command line, one a line. */
#ifndef APP_VIEW_STATE_FILE_H
#define APP_VIEW_STATE_FILE_H

#include "app/cli.h"

/* The bytes of a file; free() `text`. */
struct state_file {
    const char *path;
    char *text;
};

/* After an error `said` has the reason, as "PATH: reason" or "PATH:LINE: reason". */
bool state_file_open(struct state_file *file, const char *path, char *said, size_t said_bytes);

/* Reads the file's options into `settings`: those that `command` takes and files may contain. Empty
   lines and those that begin with # are skipped. False after an invalid line. */
bool state_file_read(struct state_file *file, const struct cli_command *command,
                     struct settings *settings, char *said, size_t said_bytes);

#endif

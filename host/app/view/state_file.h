/* Files of settings: options as on the command line, one a line. */
#ifndef APP_VIEW_STATE_FILE_H
#define APP_VIEW_STATE_FILE_H

#include "app/cli.h"

/* The bytes of a file; free() `text`. */
struct state_file {
    const char *path;
    char *text;
};

/* Why not, as "PATH: reason" or "PATH:LINE: reason", goes to `said`. */
bool state_file_open(struct state_file *file, const char *path, char *said, size_t said_bytes);

/* Reads its options into `settings`, by the rows that `command` takes and files may say. Empty
   lines and those that begin with # are skipped. False after nonsense. */
bool state_file_read(struct state_file *file, const struct cli_command *command,
                     struct settings *settings, char *said, size_t said_bytes);

#endif

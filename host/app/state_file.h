/* Files of settings: options as on the command line, one a line. */
#ifndef APP_STATE_FILE_H
#define APP_STATE_FILE_H

#include "app/cli.h"

/* The bytes of a file, which the words of its options point into; free() `text`. */
struct state_file {
    const char *path;
    char *text;
};

/* Why not, as "PATH: reason" or "PATH:LINE: reason", goes to `said`. */
bool state_file_open(struct state_file *file, const char *path, char *said, size_t said_bytes);

/* Gives each option to `read`, which is to ask the reader for its value as of the command line.
   Empty lines and those that begin with # are skipped. *reader: at the end of the file, with no
   positional argument; for checks of options against each other. False after nonsense. */
bool state_file_read(struct state_file *file, const struct cli_command *command,
                     void (*read)(void *user, struct cli_reader *reader, int id), void *user,
                     struct cli_reader *reader, char *said, size_t said_bytes);

#endif

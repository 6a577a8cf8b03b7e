/* Arguments of commands. */
#ifndef APP_ARGUMENTS_H
#define APP_ARGUMENTS_H

#include "app/cli.h"

enum { CLI_OTHERS_MAX = 4096 };

/* Reads the arguments of one command. */
struct cli_reader {
    const struct cli_command *command;
    int argc;
    char **argv;
    const char *value;                  /* of the option at hand */
    const char *positional;             /* the first argument that is not an option, or NULL */
    const char *second;                 /* the second one, where the command takes two */
    const char *others[CLI_OTHERS_MAX]; /* from the second one on, where it takes many */
    uint32_t other_count;
    bool done;         /* with `status`: no more options, or an error, or help was printed */
    int status;        /* < 0: go on with the work; else exit with it */
    const char *where; /* "FILE:LINE" of options that are not of the command line, or NULL */
    bool trusted;      /* lines of that file may say all that a command line may */
    char *left; /* gets " --NAME" of each option that no recipe may say, of a recipe; or NULL */
    size_t left_bytes;
    bool takes_files; /* with `where`: options that name files are taken, and whoever reads them
                         looks after where these lie */
    char *said;       /* gets what is wrong, in place of standard error; or NULL */
    size_t said_bytes;
};

void cli_reader_init(struct cli_reader *reader, const struct cli_command *command, int argc,
                     char **argv);
/* Reads all arguments: own options into `own`, settings into `settings`, either of which is NULL
   where the command has none. False: exit with `status`. Of a file of settings (`where`) only
   settings. */
bool cli_read(struct cli_reader *reader, void *own, struct settings *settings);
/* The next word of a line, in its place; what stands in quotes is taken as it is, but for a
   backslash in double ones, and a backslash keeps the next letter, as a shell does it; in $'' only
   what quote_word writes. NULL at the end; *whole: false where a quote has no end. */
char *cli_next_word(char **at, bool *whole);
/* Says what is wrong with the usage and how to get help; false, so that parsers can return it.
   Sets `status`. */
bool cli_misuse(struct cli_reader *reader, const char *format, ...) WHIT_PRINTF(2, 3);

/* Misuse when `path` is `-`, which other programs take for a pipe; `hint` says what to write. */
bool cli_no_dash(struct cli_reader *reader, const char *option, const char *path, const char *hint);

/* Option `i` of a command, those of help and those that are gone too; NULL: there are no more. */
const struct setting *cli_option_at(const struct cli_command *command, uint32_t i);
/* How its argument is named; "" where there is none. `text` may hold it. */
const char *cli_argument_name(const struct setting *option, char *text, size_t text_bytes);
/* Writes the help of an option into `text`, with the default that the command has in brackets.
   Gives `text`. */
const char *cli_help(const struct cli_command *command, const struct setting *option, char *text,
                     size_t text_bytes);

#endif

/* Arguments of commands. */
#ifndef APP_ARGUMENTS_H
#define APP_ARGUMENTS_H

#include "app/cli.h"

/* Reads the arguments of one command. */
struct cli_reader {
    const struct cli_command *command;
    int argc;
    char **argv;
    const char *value;                  /* of the option at hand */
    const char *positional;             /* the first argument that is not an option, or NULL */
    const char *others[CLI_OTHERS_MAX]; /* those behind it; others[0]: NULL without one */
    uint32_t other_count;
    bool done;         /* no option is left, or there was an error, or help was printed; see
                          `status` */
    int status;        /* < 0: the command goes on with its work; else the exit code */
    const char *where; /* "FILE:LINE" where the options come from a file, NULL for the command
                          line */
    bool trusted;      /* with `where`: the file may use every option that a command line may */
    char *left; /* for a recipe: gets " --NAME" of each option that recipes may not set, which is
                   skipped; else NULL */
    size_t left_bytes;
    bool takes_files; /* with `where`: options that name files are accepted, and the caller checks
                         where these files lie */
    char *said;       /* gets the error message in place of standard error; or NULL */
    size_t said_bytes;
};

void cli_reader_init(struct cli_reader *reader, const struct cli_command *command, int argc,
                     char **argv);
/* Reads all arguments: own options into `own`, settings into `settings`, either of which is NULL
   where the command has none. False: exit with `status`. From a file of settings (`where`) only
   settings are accepted. Options with `written` that name a file which the command reads, or each
   other's, are refused here. */
bool cli_read(struct cli_reader *reader, void *own, struct settings *settings);
/* Gives the next word of a line, unquoted in place by the rules of a shell: quoted text is literal
   except for a backslash in double quotes, and a backslash keeps the next character. $'...' is read
   only in the form that quote_word writes. NULL at the end; *whole: false where a quote is not
   closed. */
char *cli_next_word(char **at, bool *whole);
/* The command line of a run, quoted for a shell; free() it. NULL: out of memory. */
char *cli_line(int argc, char **argv);
/* Says what is wrong with the usage and how to get help; false, so that parsers can return it.
   Sets `status`. */
bool cli_misuse(struct cli_reader *reader, const char *format, ...) WHIT_PRINTF(2, 3);
/* Does so, and gives the status, so that commands can return it. */
#define CLI_MISUSE(reader, ...) (cli_misuse((reader), __VA_ARGS__), (reader)->status)

/* Calls cli_misuse where `path` is `-`, which other programs take for a pipe; `hint` says what to
   write instead. */
bool cli_no_dash(struct cli_reader *reader, const char *option, const char *path, const char *hint);
/* Checks by cli_can_write that `path` can be written, and sets `status`; NULL: nothing to check. */
bool cli_check_writable(struct cli_reader *reader, const char *path);
/* Both checks. */
bool cli_check_output(struct cli_reader *reader, const char *option, const char *path,
                      const char *hint);

/* Finds the last run of # in the name of a file, not in its folders. Gives its offset and *length;
 *length 0: there is none. */
size_t cli_find_marks(const char *pattern, size_t *length);
/* A file of the command line, or one that a command finds by itself. */
struct cli_file {
    const char *name; /* of its option, or what it is */
    const char *path; /* NULL: there is none */
    bool written;
};
/* Whether both name one file, under whatever names. What several outputs may go to, /dev/null, is
   none. */
bool cli_same_file(const char *a, const char *b);
/* Calls cli_misuse where two of these, of which one is written, are the same file. */
bool cli_check_apart(struct cli_reader *reader, const struct cli_file *files, uint32_t count);

/* Option `i` of a command, including --help and options of kind SETTING_GONE; NULL: there are no
   more. */
const struct setting *cli_option_at(const struct cli_command *command, uint32_t i);
/* The name of the option's argument; "" where it takes none. The result may point to `text`. */
const char *cli_argument_name(const struct setting *option, char *text, size_t text_bytes);
/* Writes the help of an option into `text`, with the default that the command has in brackets.
   Gives `text`. */
const char *cli_help(const struct cli_command *command, const struct setting *option, char *text,
                     size_t text_bytes);

#endif

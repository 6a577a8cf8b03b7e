/* Prints commands, options and their words for completion by shells and for docs/cli.md, and writes
   manual pages. */
#ifndef APP_DESCRIBE_H
#define APP_DESCRIBE_H

#include "app/cli.h"

/* Prints lines of "WORD<tab>ABOUT" on standard output for what may follow `words`, which end with
   NULL. No word: the commands; a command: its options; a command and an option: the words that its
   value may be or begin with, and nothing for numbers and files. */
int describe_complete(const struct cli_command *const *commands, uint32_t count,
                      const char *const *words);
/* Prints the options of all commands as a table of Markdown, for docs/cli.md. */
int describe_table(const struct cli_command *const *commands, uint32_t count);
/* Two lines of help that explain `whit FILE`, a file in place of a command. */
extern const char *const describe_file;
/* Writes whit.1 and a page for each command, whit-COMMAND.1, into an existing folder. */
int describe_manual(const struct cli_command *const *commands, uint32_t count, const char *folder);

#endif

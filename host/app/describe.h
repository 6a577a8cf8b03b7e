/* Prints commands, options and their words for completion by shells and for docs/cli.md, and writes
   manual pages. */
#ifndef APP_DESCRIBE_H
#define APP_DESCRIBE_H

#include "app/cli.h"

/* Lines of "WORD<tab>ABOUT" on standard output. `words` ends with NULL: none: commands; a command:
   its options; a command and an option: the words that its value may be, or begin with; nothing
   where it is a number or a file. */
int describe_complete(const struct cli_command *const *commands, uint32_t count,
                      const char *const *words);
/* Prints the options of all commands as a table of Markdown, for docs/cli.md. */
int describe_table(const struct cli_command *const *commands, uint32_t count);
/* Writes whit.1 and a page a command, whit-COMMAND.1, into a folder that there is. */
int describe_manual(const struct cli_command *const *commands, uint32_t count, const char *folder);

#endif

/* Quotes words of a command line so that a shell gives them to another run unchanged. */
#ifndef SETTINGS_QUOTE_H
#define SETTINGS_QUOTE_H

#include <stdio.h>

/* Gives `put` the parts of `word`, in their order: the word as it is, or in single quotes where a
   POSIX shell would split or expand it. Characters that whit_text_next escapes are written as
   $'\x1b', which bash and zsh turn back into these bytes. A part is valid during the call of `put`
   only. */
void quote_word(const char *word, void (*put)(void *user, const char *part), void *user);
/* Writes the parts of `word` to a stream. */
void quote_print(const char *word, FILE *to);

#endif

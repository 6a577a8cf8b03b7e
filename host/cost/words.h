/* Words of a command line that another run is to take. */
#ifndef COST_WORDS_H
#define COST_WORDS_H

/* Gives `put` the parts of `word`, in their order: the word as it is, or in single quotes where a
   POSIX shell would take it apart. What whit_text_next shows as an escape is written in the form
   $'\x1b', which bash and zsh take as those bytes. A part is valid during the call only. */
void words_quote(const char *word, void (*put)(void *user, const char *part), void *user);

#endif

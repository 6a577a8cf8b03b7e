/* Words of a command line that another run is to take. */
#ifndef SETTINGS_QUOTE_H
#define SETTINGS_QUOTE_H

/* Gives `put` the parts of `word`, in their order: the word as it is, or in single quotes where a
   POSIX shell would take it apart. What whit_text_next shows as an escape is written in the form
   $'\x1b', which bash and zsh take as those bytes. A part is valid during the call only. */
void quote_word(const char *word, void (*put)(void *user, const char *part), void *user);

#endif

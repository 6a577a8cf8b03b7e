/* What a message quotes of a file. */
#ifndef BASE_TEXT_H
#define BASE_TEXT_H

#include "whit/whit_base.h"

/* A message quotes at most this many characters of a file: enough to find the place, too few to
   read the file by its messages. */
enum { TEXT_TOKEN_CHARACTERS = 40 };

struct text_token {
    char text[4 * TEXT_TOKEN_CHARACTERS + sizeof "..."];
};

/* The start of `text`, and `...` where there is more of it; not shown yet, the log does that. NULL
   is as "". Made to be used where it is called: "%s", text_token(name).text */
struct text_token text_token(const char *text);

/* The name nearest to `word`, by changes of a letter; NULL when none is near. */
const char *text_nearest(const char *word, const char *const *names, uint32_t count);

#endif

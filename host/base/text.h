/* Small functions for text of files: places in it, numbers, and how messages quote it. */
#ifndef BASE_TEXT_H
#define BASE_TEXT_H

#include <stdarg.h>

#include "whit/whit_image.h"

/* The most characters of a file that a message quotes: enough to find the place, too few to read
   the file through messages. */
enum { TEXT_TOKEN_CHARACTERS = 40 };

struct text_token {
    char text[4 * TEXT_TOKEN_CHARACTERS + sizeof "..."];
};

/* The start of `text`, and `...` where it is longer. It still has to go through whit_text_show,
   which the log does. NULL is as "". Use it in the same expression: "%s", text_token(name).text */
struct text_token text_token(const char *text);

/* Bytes of the byte order mark of UTF-8 that `text` begins with, as some editors write it: 3 or 0.
 */
size_t text_mark_bytes(const char *text);

/* Cuts the carriage return with which a line of text may end. False: there is another one in it. */
bool text_end_line(char *line);

/* Reads the digits that `text` begins with; gives the text behind them. NULL: there are none, or
   the number is above `max`. */
const char *text_number(const char *text, uint32_t max, uint32_t *out);

/* As vsnprintf and strtod, but numbers have a point whatever the locale of the program that uses
   the library: texts that whit writes, and files, are the same in all of them. */
int text_print(char *text, size_t bytes, const char *format, va_list args) WHIT_PRINTF(3, 0);
double text_real(const char *text, char **end);

/* Appends to `text`, which lies in a buffer of `bytes`. What does not fit is cut. */
void text_add(char *text, size_t bytes, const char *format, ...) WHIT_PRINTF(3, 4);

/* The value of the first text of a picture with this key; NULL: there is none. A picture that was
   tampered with may have several, and all readers have to take the same one. */
const char *text_value(const whit_text *texts, uint32_t count, const char *key);

/* The name with the fewest changed letters from `word`; NULL when none is near. */
const char *text_nearest(const char *word, const char *const *names, uint32_t count);

#endif

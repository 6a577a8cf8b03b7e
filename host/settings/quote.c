#include "settings/quote.h"

#include <stdbool.h>
#include <string.h>

#include "whit/whit.h"

static bool is_plain(const char *word)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                "-_./:,+=@%";
    return word[0] && word[strspn(word, plain)] == '\0';
}

/* Writes bytes as $'...' inside a word in single quotes: ends these quotes before, and begins them
   again behind. */
static void put_bytes(const char *bytes, size_t count, void (*put)(void *user, const char *part),
                      void *user)
{
    put(user, "'$'");
    for (size_t i = 0; i < count; ++i) {
        char one[5];
        snprintf(one, sizeof one, "\\x%02x", (unsigned)(unsigned char)bytes[i]);
        put(user, one);
    }
    put(user, "''");
}

void quote_word(const char *word, void (*put)(void *user, const char *part), void *user)
{
    if (is_plain(word)) {
        put(user, word);
        return;
    }
    char shown[WHIT_SHOWN_BYTES];
    put(user, "'");
    for (size_t length; (length = whit_text_next(word, shown)) != 0; word += length) {
        if (strncmp(shown, word, length) == 0)
            put(user, *word == '\'' ? "'\\''" : shown);
        else
            put_bytes(word, length, put, user);
    }
    put(user, "'");
}

static void print_part(void *user, const char *part)
{
    fputs(part, user);
}

void quote_print(const char *word, FILE *to)
{
    quote_word(word, print_part, to);
}

#include "cost/words.h"

#include <stdbool.h>
#include <string.h>

static bool is_plain(const char *word)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                "-_./:,+=@%";
    return word[0] && word[strspn(word, plain)] == '\0';
}

void words_quote(const char *word, void (*put)(void *user, const char *part), void *user)
{
    if (is_plain(word)) {
        put(user, word);
        return;
    }
    put(user, "'");
    for (; *word; ++word) {
        const char one[2] = {*word, '\0'};
        put(user, *word == '\'' ? "'\\''" : one);
    }
    put(user, "'");
}

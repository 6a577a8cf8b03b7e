#include "base/text.h"

#include <ctype.h>
#include <locale.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Number of bytes of the character that `text` starts with; 0: it is no UTF-8, or an overlong
   encoding. */
static size_t decode(const unsigned char *text, uint32_t *code)
{
    static const uint32_t min[5] = {0, 0, 0x80, 0x800, 0x10000};
    *code = text[0];
    if (text[0] < 0x80)
        return 1;
    if (text[0] < 0xc2 || text[0] > 0xf4)
        return 0;
    size_t length = text[0] >= 0xf0 ? 4 : text[0] >= 0xe0 ? 3 : 2;
    *code = text[0] & (0x7fu >> length);
    for (size_t i = 1; i < length; ++i) {
        if ((text[i] & 0xc0) != 0x80) /* also the terminating 0 */
            return 0;
        *code = *code << 6 | (text[i] & 0x3fu);
    }
    bool surrogate = *code >= 0xd800 && *code < 0xe000;
    return *code < min[length] || *code > 0x10ffff || surrogate ? 0 : length;
}

/* Whether a character controls a terminal, or is invisible and changes how the text around it
   reads. */
static bool is_hidden(uint32_t code)
{
    static const struct {
        uint32_t first, last;
    } hidden[] = {
        {0x00, 0x1f},       {0x7f, 0x9f},       /* C0, DEL, C1 */
        {0xad, 0xad},       {0x34f, 0x34f},     /* a hyphen at line ends only, a joiner */
        {0x61c, 0x61c},     {0x115f, 0x1160},   /* a direction, fillers of Hangul */
        {0x17b4, 0x17b5},   {0x180b, 0x180f},   /* vowels and variants that are not seen */
        {0x200b, 0x200f},   {0x2028, 0x202e},   /* no width; ends of lines, directions */
        {0x2060, 0x206f},   {0x3164, 0x3164},   /* joiners, directions; a filler */
        {0xfe00, 0xfe0f},                       /* variants of characters */
        {0xfeff, 0xfeff},   {0xffa0, 0xffa0},   /* a byte order mark, a filler */
        {0xfff0, 0xfffb},   {0x1bca0, 0x1bca3}, /* marks of annotations and of shorthand */
        {0x1d173, 0x1d17a}, {0xe0000, 0xe0fff}, /* marks of music, tags */
    };
    for (size_t i = 0; i < sizeof hidden / sizeof *hidden; ++i) {
        if (code >= hidden[i].first && code <= hidden[i].last)
            return true;
    }
    return (code & 0xfffe) == 0xfffe || (code >= 0xfdd0 && code <= 0xfdef); /* noncharacters */
}

size_t whit_text_next(const char *text, char shown[WHIT_SHOWN_BYTES])
{
    uint32_t code;
    size_t length = decode((const unsigned char *)text, &code);
    shown[0] = 0;
    if (!text[0])
        return 0;
    if (length && !is_hidden(code)) {
        memcpy(shown, text, length);
        shown[length] = 0;
    } else if (!length) {
        snprintf(shown, WHIT_SHOWN_BYTES, "\\x%02x", (unsigned)(unsigned char)text[0]);
        length = 1;
    } else if (code < 0x10000) {
        snprintf(shown, WHIT_SHOWN_BYTES, "\\u%04x", code & 0xffffu);
    } else {
        code -= 0x10000;
        snprintf(shown, WHIT_SHOWN_BYTES, "\\u%04x\\u%04x", 0xd800u + (code >> 10 & 0x3ffu),
                 0xdc00u + (code & 0x3ffu));
    }
    return length;
}

char *whit_text_show(const char *text, char *out, size_t out_bytes)
{
    char shown[WHIT_SHOWN_BYTES];
    size_t used = 0, whole = 0; /* `whole`: the last place in `out` where `...` fits */
    out[0] = 0;
    for (size_t length; (length = whit_text_next(text, shown)) != 0; text += length) {
        size_t more = strlen(shown);
        if (used + more >= out_bytes) {
            strcpy(out + whole, "...");
            break;
        }
        memcpy(out + used, shown, more + 1);
        used += more;
        whole = used + sizeof "..." <= out_bytes ? used : whole;
    }
    return out;
}

struct text_token text_token(const char *text)
{
    struct text_token token;
    char shown[WHIT_SHOWN_BYTES];
    size_t used = 0, length = 1;
    for (int i = 0; text && i < TEXT_TOKEN_CHARACTERS && length; ++i) {
        length = whit_text_next(text + used, shown);
        used += length;
    }
    memcpy(token.text, text ? text : "", used);
    strcpy(token.text + used, text && text[used] ? "..." : "");
    return token;
}

size_t text_mark_bytes(const char *text)
{
    return strncmp(text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
}

bool text_end_line(char *line)
{
    size_t length = strlen(line);
    if (length && line[length - 1] == '\r')
        line[length - 1] = '\0';
    return strchr(line, '\r') == NULL;
}

const char *text_number(const char *text, uint32_t max, uint32_t *out)
{
    uint64_t value = 0;
    const char *at = text;
    for (; isdigit((unsigned char)*at) && value <= max; ++at)
        value = 10 * value + (uint64_t)(*at - '0');
    *out = (uint32_t)value;
    return at > text && value <= max ? at : NULL;
}

/* The C library has this locale ready: nothing is allocated, and nothing is to be freed. */
static locale_t locale_of_files(void)
{
    return newlocale(LC_ALL_MASK, "C", (locale_t)0);
}

int text_print(char *text, size_t bytes, const char *format, va_list args)
{
    locale_t before = uselocale(locale_of_files());
    int length = vsnprintf(text, bytes, format, args);
    uselocale(before);
    return length;
}

double text_real(const char *text, char **end)
{
    locale_t before = uselocale(locale_of_files());
    double number = strtod(text, end);
    uselocale(before);
    return number;
}

void text_add(char *text, size_t bytes, const char *format, ...)
{
    size_t used = strlen(text);
    va_list args;
    va_start(args, format);
    text_print(text + used, bytes - used, format, args);
    va_end(args);
}

/* ---- Words that are near ---- */

enum { WORD_MAX = 63 };

/* Levenshtein's distance, with swapped neighbours as one step. */
static uint32_t distance(const char *a, const char *b)
{
    uint32_t rows[3][WORD_MAX + 1];
    uint32_t length_b = (uint32_t)strlen(b);
    for (uint32_t j = 0; j <= length_b; ++j)
        rows[0][j] = j;
    for (uint32_t i = 1; a[i - 1]; ++i) {
        uint32_t *row = rows[i % 3], *above = rows[(i - 1) % 3], *higher = rows[(i + 1) % 3];
        row[0] = i;
        for (uint32_t j = 1; j <= length_b; ++j) {
            char x = (char)tolower((unsigned char)a[i - 1]);
            char y = (char)tolower((unsigned char)b[j - 1]);
            uint32_t best = above[j - 1] + (x != y);
            if (above[j] + 1 < best)
                best = above[j] + 1;
            if (row[j - 1] + 1 < best)
                best = row[j - 1] + 1;
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] &&
                higher[j - 2] + 1 < best)
                best = higher[j - 2] + 1;
            row[j] = best;
        }
    }
    return rows[strlen(a) % 3][length_b];
}

const char *text_nearest(const char *word, const char *const *names, uint32_t count)
{
    const char *nearest = NULL;
    size_t length = strlen(word);
    uint32_t min = length <= 3 ? 1 : length <= 6 ? 2 : 3;
    if (length == 0 || length > WORD_MAX)
        return NULL;
    for (uint32_t i = 0; i < count; ++i) {
        if (strlen(names[i]) > WORD_MAX || !names[i][0])
            continue;
        uint32_t steps = distance(word, names[i]);
        bool prefix = strncmp(word, names[i], length) == 0;
        if (steps <= min || (prefix && !nearest)) {
            nearest = names[i];
            min = steps < min ? steps : min;
        }
    }
    return nearest;
}

const char *text_value(const whit_text *texts, uint32_t count, const char *key)
{
    for (uint32_t i = 0; i < count; ++i) {
        if (strcmp(texts[i].key, key) == 0)
            return texts[i].value;
    }
    return NULL;
}

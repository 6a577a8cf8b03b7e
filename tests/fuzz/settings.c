/* Files of settings, by options that take each kind of value; and words that are quoted as the
   program quotes them, which are read as they were. */
#include "fuzz.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/state_file.h"
#include "cost/words.h"
#include "settings/values.h"

enum { ID_FLAG = 'q', ID_TEXT = 256, ID_COUNT, ID_BYTES, ID_NUMBER, ID_SIZE, ID_CHOICE };

static const struct setting_value choices[] = {{"a", 1, NULL}, {"b", 2, NULL}, {0}};
static const struct cli_option options[] = {
    {ID_FLAG, "quiet", NULL, "a flag", NULL},         {ID_TEXT, "text", "T", "a text", NULL},
    {ID_COUNT, "count", "N", "a count", NULL},        {ID_BYTES, "bytes", "B", "bytes", NULL},
    {ID_NUMBER, "number", "X", "a number", NULL},     {ID_SIZE, "size", "WxH", "two counts", NULL},
    {ID_CHOICE, "choice", NULL, "a choice", choices}, {0},
};
static const struct cli_command command = {
    .name = "fuzz", .arguments = "", .summary = "", .options = options};

static char *text; /* the last one that --text gave */

static void read_option(void *user, struct cli_reader *reader, int id)
{
    uint32_t a = 7, b = 7;
    uint64_t bytes = 7;
    double number = 7.0;
    (void)user;
    if (id == ID_TEXT) {
        free(text);
        text = strdup(reader->value);
        fuzz_check(text, "out of memory");
    }
    if (id == ID_COUNT && cli_unsigned(reader, 2, 9, &a))
        fuzz_check(a >= 2 && a <= 9, "`%s` is %u", reader->value, a);
    if (id == ID_BYTES && cli_bytes(reader, &bytes))
        fuzz_check(bytes > 0, "`%s` is nothing", reader->value);
    if (id == ID_NUMBER && cli_number(reader, -2.0, 9.0, &number))
        fuzz_check(number >= -2.0 && number <= 9.0, "`%s` is %g", reader->value, number);
    if (id == ID_SIZE && cli_size(reader, &a, &b))
        fuzz_check(a > 0 && b > 0, "`%s` is %ux%u", reader->value, a, b);
    if (id == ID_CHOICE && cli_choice_unsigned(reader, &a))
        fuzz_check(a == 1 || a == 2, "`%s` is choice %u", reader->value, a);
}

static bool read_file(const char *path, char *said, size_t said_bytes)
{
    struct state_file file;
    struct cli_reader reader;
    said[0] = 0;
    if (!state_file_open(&file, path, said, said_bytes))
        return false;
    bool good = state_file_read(&file, &command, read_option, NULL, &reader, said, said_bytes);
    free(file.text);
    return good;
}

/* --- words ---------------------------------------------------------------------------------- */

struct line {
    char *text;
    size_t used, room;
};

static void put_part(void *user, const char *part)
{
    struct line *line = user;
    size_t bytes = strlen(part);
    fuzz_check(line->used + bytes < line->room, "a word becomes too long");
    memcpy(line->text + line->used, part, bytes + 1);
    line->used += bytes;
}

static void check_word(const uint8_t *data, size_t size_bytes)
{
    enum { WORD_MOST = 512, A_BYTE = 16, HEAD = 16 };
    char word[WORD_MOST + 1], buffer[HEAD + A_BYTE * WORD_MOST], said[256];
    struct line line = {.text = buffer, .room = sizeof buffer};
    size_t length = size_bytes < WORD_MOST ? size_bytes : WORD_MOST;
    memcpy(word, data, length);
    word[length] = 0;
    put_part(&line, "--text=");
    words_quote(word, put_part, &line);
    const char *path = fuzz_file("words", line.text, line.used);
    fuzz_check(read_file(path, said, sizeof said), "%s", said);
    fuzz_check(text && strcmp(text, word) == 0, "`%s` is read as `%s`", word, text ? text : "");
}

static void run(const uint8_t *data, size_t size_bytes)
{
    char said[256];
    const char *path = fuzz_file("settings", data, size_bytes);
    bool good = read_file(path, said, sizeof said);
    fuzz_check(good == !said[0], "%s: `%s`", good ? "read" : "refused", said);
    fuzz_check(good || strncmp(said, path, strlen(path)) == 0, "`%s` does not name the file", said);
    check_word(data, size_bytes);
}

const struct fuzz_target fuzz_target = {.run = run, .memory_bytes = UINT64_C(1) << 20};

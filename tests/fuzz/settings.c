/* Files of settings, by the table of settings; and words that are quoted as the program quotes
   them, which are read as they were. */
#include "fuzz.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/view/state_file.h"
#include "settings/quote.h"

static const struct setting none[] = {{0}};
static const struct cli_command command = {
    .name = "fuzz", .arguments = "", .summary = "", .options = none, .settings = IN_VIEW};

/* Each value is written as it was read, and reads back as itself. */
static void check_values(const struct settings *settings)
{
    for (const struct setting *row = settings_table; row->name; ++row) {
        char text[SETTING_VALUE_BYTES], why[SETTING_WHY_BYTES];
        struct settings again = settings_usual();
        if (!(row->commands & IN_VIEW) || row->kind == SETTING_FLAG ||
            setting_same(row, settings, &again) || !setting_write(row, settings, 0, text))
            continue;
        fuzz_check(setting_read(row, text, &again, why), "--%s%s", row->name, why);
        fuzz_check(setting_same(row, settings, &again), "--%s %s", row->name, text);
    }
}

static bool read_file(const char *path, struct settings *settings, char *said, size_t said_bytes)
{
    struct state_file file;
    *settings = settings_usual();
    said[0] = 0;
    if (!state_file_open(&file, path, said, said_bytes))
        return false;
    bool good = state_file_read(&file, &command, settings, said, said_bytes);
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
    enum { WORD_MAX = SETTING_TEXT_BYTES - 1, A_BYTE = 16, HEAD = 16 };
    struct settings settings;
    char word[WORD_MAX + 1], buffer[HEAD + A_BYTE * WORD_MAX], said[256];
    struct line line = {.text = buffer, .room = sizeof buffer};
    size_t length = size_bytes < WORD_MAX ? size_bytes : WORD_MAX;
    memcpy(word, data, length);
    word[length] = 0;
    put_part(&line, "--camera=");
    quote_word(word, put_part, &line);
    const char *path = fuzz_file("words", line.text, line.used);
    if (!word[0])
        return;
    fuzz_check(read_file(path, &settings, said, sizeof said), "%s", said);
    fuzz_check(strcmp(settings.camera, word) == 0, "`%s` is read as `%s`", word, settings.camera);
}

static void run(const uint8_t *data, size_t size_bytes)
{
    char said[256];
    const char *path = fuzz_file("settings", data, size_bytes);
    struct settings settings;
    bool good = read_file(path, &settings, said, sizeof said);
    fuzz_check(good == !said[0], "%s: `%s`", good ? "read" : "refused", said);
    fuzz_check(good || strncmp(said, path, strlen(path)) == 0, "`%s` does not name the file", said);
    if (good)
        check_values(&settings);
    check_word(data, size_bytes);
}

const struct fuzz_target fuzz_target = {.run = run, .memory_bytes = UINT64_C(1) << 20};

#include "app/view/state_file.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "app/arguments.h"
#include "base/file.h"

enum { STATE_BYTES_MAX = 65536, WORDS_MAX = 8, WHERE_BYTES = 600 };

bool state_file_open(struct state_file *file, const char *path, char *said, size_t said_bytes)
{
    const char *why;
    *file = (struct state_file){.path = path};
    errno = 0;
    FILE *from = file_open(path, &why);
    size_t length = 0;
    file->text = malloc(STATE_BYTES_MAX + 1);
    if (from && file->text)
        length = fread(file->text, 1, STATE_BYTES_MAX + 1, from);
    bool failed = !from || !file->text || ferror(from);
    bool good = !failed && length <= STATE_BYTES_MAX && !memchr(file->text, '\0', length);
    if (failed)
        snprintf(said, said_bytes, "%s: cannot be read: %s", path,
                 from ? strerror(errno ? errno : EIO) : why);
    else if (!good)
        snprintf(said, said_bytes, "%s: not a file of settings", path);
    if (from)
        fclose(from);
    if (good)
        file->text[length] = '\0';
    else
        free(file->text);
    file->text = good ? file->text : NULL;
    return good;
}

/* Splits a line into words behind argv[0], the command's name; false where it has too many. */
static bool split(struct cli_reader *reader, char *line, char *argv[WORDS_MAX + 1])
{
    bool whole = true;
    char *word;
    while (whole && (word = cli_next_word(&line, &whole)) != NULL) {
        if (reader->argc == WORDS_MAX)
            return cli_misuse(reader, "one option a line");
        argv[reader->argc++] = word;
    }
    argv[reader->argc] = NULL;
    return whole || cli_misuse(reader, "a quote has no end");
}

static bool read_line(struct cli_reader *reader, char *line, struct settings *settings)
{
    static char name[] = "whit";
    char *argv[WORDS_MAX + 1] = {name};
    reader->argv = argv;
    if (line[strspn(line, " \t\r")] == '#')
        return true;
    if (!split(reader, line, argv) || !cli_read(reader, NULL, settings))
        return false;
    return !reader->positional || cli_misuse(reader, "`%s` is no option", reader->positional);
}

bool state_file_read(struct state_file *file, const struct cli_command *command,
                     struct settings *settings, char *said, size_t said_bytes)
{
    char where[WHERE_BYTES], why[SETTING_WHY_BYTES];
    uint32_t number = 0;
    for (char *line = file->text, *end; line; line = end) {
        struct cli_reader reader;
        end = strchr(line, '\n');
        if (end)
            *end++ = '\0';
        snprintf(where, sizeof where, "%.500s:%u", file->path, ++number);
        cli_reader_init(&reader, command, 1, NULL);
        reader.where = where;
        reader.said = said;
        reader.said_bytes = said_bytes;
        if (!read_line(&reader, line, settings))
            return false;
    }
    if (settings_check(settings, why))
        return true;
    snprintf(said, said_bytes, "%.500s:%u: %s", file->path, number, why);
    return false;
}

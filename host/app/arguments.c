/* Parses command lines by getopt_long and prints help, both from one table of options, so that they
   cannot drift apart. */
#define _GNU_SOURCE
#include "app/arguments.h"

#include <getopt.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/input.h"
#include "base/path.h"
#include "base/text.h"
#include "settings/quote.h"

enum { OPTIONS_MAX = 96, ID_FIRST = 256, HELP_COLUMN = 27 };

/* Follow the options of every command. */
static const struct setting help_options[] = {
    {"help", 'h', NULL, "print this help", .kind = SETTING_HELP},
    {"help-all", 0, NULL, "and the options for those who work on whit", .kind = SETTING_HELP},
};

const char *cli_argument_name(const struct setting *option, char *text, size_t text_bytes)
{
    if (!setting_has_argument(option))
        return "";
    return option->argument ? option->argument : value_list(option->values, "|", text, text_bytes);
}

static bool is_own(const struct cli_command *command, const struct setting *option)
{
    const struct setting *own = command->options;
    while (own->name && own != option)
        ++own;
    return own == option && own->name;
}

/* Whether the command takes this row of the table of settings. It does not where it has an option
   of the same name itself. */
static bool is_taken(const struct cli_command *command, const struct setting *row)
{
    for (const struct setting *own = command->options; own->name; ++own) {
        if (strcmp(own->name, row->name) == 0)
            return false;
    }
    return row->commands & command->settings;
}

static bool has_developers(const struct cli_command *command)
{
    for (const struct setting *row = settings_table; row->name; ++row) {
        if (row->developer && is_taken(command, row))
            return true;
    }
    return false;
}

const struct setting *cli_option_at(const struct cli_command *command, uint32_t i)
{
    uint32_t before = 0;
    for (const struct setting *own = command->options; own->name; ++own) {
        if (before++ == i)
            return own;
    }
    for (const struct setting *row = settings_table; row->name; ++row) {
        if (is_taken(command, row) && before++ == i)
            return row;
    }
    return i - before < (has_developers(command) ? 2 : 1) ? &help_options[i - before] : NULL;
}

static const struct setting *find_option(const struct cli_command *command, int id)
{
    const struct setting *option = NULL;
    if (id >= ID_FIRST)
        return cli_option_at(command, (uint32_t)(id - ID_FIRST));
    for (uint32_t i = 0; (option = cli_option_at(command, i)) && option->letter != id; ++i)
        ;
    return option;
}

/* ---- Help ---- */

const char *cli_help(const struct cli_command *command, const struct setting *option, char *text,
                     size_t text_bytes)
{
    struct settings settings = settings_usual();
    char value[SETTING_VALUE_BYTES];
    const char *usual = option->usual;
    if (command->usual)
        command->usual(&settings);
    bool has_one = option->kind != SETTING_FLAG && option->kind != SETTING_GONE &&
                   !is_own(command, option) && setting_write(option, &settings, 0, value);
    if (!usual && has_one)
        usual = value;
    snprintf(text, text_bytes, usual && usual[0] ? "%s (%s)" : "%s", option->help, usual);
    return text;
}

static void print_option(const struct cli_command *command, const struct setting *option, FILE *to)
{
    char left[120], argument[80], help[1024];
    char letter[8] = "    ";
    if (option->letter)
        snprintf(letter, sizeof letter, "-%c, ", option->letter);
    snprintf(left, sizeof left, "  %s--%s%s%s", letter, option->name,
             setting_has_argument(option) ? " " : "",
             cli_argument_name(option, argument, sizeof argument));
    if (strlen(left) + 2 > HELP_COLUMN)
        fprintf(to, "%s\n%*s", left, HELP_COLUMN, "");
    else
        fprintf(to, "%-*s", HELP_COLUMN, left);
    for (const char *line = cli_help(command, option, help, sizeof help); *line;) {
        size_t length = strcspn(line, "\n");
        fprintf(to, "%.*s\n", (int)length, line);
        line += length + (line[length] != 0);
        if (*line)
            fprintf(to, "%*s", HELP_COLUMN, "");
    }
}

static void print_help(const struct cli_command *command, bool all, FILE *to)
{
    const struct setting *option;
    fprintf(to, "usage: whit %s %s\n\n%s\n\noptions:\n", command->name, command->arguments,
            command->summary);
    for (uint32_t i = 0; (option = cli_option_at(command, i)); ++i) {
        if (option->kind != SETTING_GONE && (all || !option->developer))
            print_option(command, option, to);
    }
    if (command->details)
        fprintf(to, "\n%s", command->details);
}

/* ---- Command line ---- */

void cli_reader_init(struct cli_reader *reader, const struct cli_command *command, int argc,
                     char **argv)
{
    *reader = (struct cli_reader){.command = command, .argc = argc, .argv = argv, .status = -1};
    optind = 0; /* from the beginning, whatever was read before */
    opterr = 0;
}

/* Copies a printf format so that each quoted %s prints at most 40 bytes: messages quote words of a
   file up to 40 bytes, words of the command line whole. */
static void limit_quotes(const char *format, char *limited, size_t bytes)
{
    size_t used = 0;
    for (bool quoted = false; *format && used + 5 < bytes; ++format) {
        quoted ^= *format == '`';
        limited[used++] = *format;
        if (quoted && format[0] == '%' && format[1] == 's') {
            memcpy(limited + used, ".40", 3);
            used += 3;
        }
    }
    limited[used] = '\0';
}

bool cli_misuse(struct cli_reader *reader, const char *format, ...)
{
    char text[1024], limited[512];
    va_list args;
    limit_quotes(format, limited, sizeof limited);
    va_start(args, format);
    vsnprintf(text, sizeof text, reader->where ? limited : format, args);
    va_end(args);
    if (reader->said)
        snprintf(reader->said, reader->said_bytes, "%s: %s", reader->where, text);
    else
        cli_error("%s (see `whit %s --help`)", text, reader->command->name);
    reader->done = true;
    reader->status = EXIT_USAGE;
    return false;
}

static struct option *long_options(const struct cli_command *command,
                                   struct option table[OPTIONS_MAX], char *shorts)
{
    const struct setting *option;
    *shorts++ = '-'; /* getopt returns arguments that are no options in order, as id 1 */
    *shorts++ = ':';
    for (uint32_t i = 0; (option = cli_option_at(command, i)) && i + 1 < OPTIONS_MAX; ++i) {
        table[i] = (struct option){
            .name = option->name,
            .has_arg = option->kind == SETTING_GONE   ? optional_argument
                       : setting_has_argument(option) ? required_argument
                                                      : no_argument,
            .val = ID_FIRST + (int)i,
        };
        table[i + 1] = (struct option){0};
        if (option->letter) {
            *shorts++ = option->letter;
            if (setting_has_argument(option))
                *shorts++ = ':';
        }
    }
    *shorts = 0;
    return table;
}

/* Reports the word in argv that getopt did not understand. */
static void unknown_option(struct cli_reader *reader)
{
    if (optopt && optopt < ID_FIRST && !find_option(reader->command, optopt)) {
        cli_misuse(reader, "there is no option `-%c`", optopt);
        return;
    }
    const char *word = reader->argv[optind - 1];
    if (optopt) { /* --quiet=3 */
        const struct setting *unasked = find_option(reader->command, optopt);
        cli_misuse(reader, "option `--%s` takes no value", unasked ? unasked->name : word);
        return;
    }
    char name[64] = "";
    if (strncmp(word, "--", 2) == 0)
        snprintf(name, sizeof name, "%.*s", (int)strcspn(word + 2, "="), word + 2);
    const char *names[OPTIONS_MAX];
    uint32_t count = 0;
    const struct setting *option;
    for (uint32_t i = 0; (option = cli_option_at(reader->command, i)) && count < OPTIONS_MAX; ++i) {
        if (option->kind != SETTING_GONE && option->kind != SETTING_HELP)
            names[count++] = option->name;
    }
    const char *nearest = text_nearest(name, names, count);
    if (nearest)
        cli_misuse(reader, "there is no option `--%s`; did you mean `--%s`?", name, nearest);
    else
        cli_misuse(reader, "there is no option `%s`", word);
}

static bool take_positional(struct cli_reader *reader, const char *word)
{
    if (!reader->positional)
        reader->positional = word;
    else if (reader->other_count < reader->command->others_max)
        reader->others[reader->other_count++] = word;
    else
        return cli_misuse(reader, "`%s` is one argument too many", word);
    return true;
}

/* The next option, with reader->value; NULL at the end. */
static const struct setting *next(struct cli_reader *reader)
{
    struct option table[OPTIONS_MAX];
    char shorts[2 * OPTIONS_MAX + 3];
    long_options(reader->command, table, shorts);
    while (!reader->done) {
        optopt = 0;
        int id = getopt_long(reader->argc, reader->argv, shorts, table, NULL);
        const struct setting *option =
            id > 1 && id != ':' && id != '?' ? find_option(reader->command, id) : NULL;
        if (id == 1) {
            take_positional(reader, optarg);
        } else if (id == -1) {
            while (optind < reader->argc && take_positional(reader, reader->argv[optind]))
                ++optind;
            reader->done = true;
        } else if (id == ':') {
            char argument[80] = "?";
            option = find_option(reader->command, optopt);
            cli_misuse(reader, "option `--%s` needs a value: %s", option ? option->name : "?",
                       option ? cli_argument_name(option, argument, sizeof argument) : argument);
        } else if (!option) {
            unknown_option(reader);
        } else if (option->kind == SETTING_GONE) {
            cli_misuse(reader, "option `--%s` %s", option->name, option->help);
        } else if (option->kind == SETTING_HELP && reader->where) {
            cli_misuse(reader, "--help is for the command line alone");
        } else if (option->kind == SETTING_HELP) {
            print_help(reader->command, option == &help_options[1], stdout);
            reader->done = true;
            reader->status = cli_finish_stdout(EXIT_FINE);
        } else {
            reader->value = optarg;
            return option;
        }
    }
    return NULL;
}

/* Shortens `value`, read from a file of settings, to 40 characters where `why` quotes it. */
static void shorten(const char *value, char why[SETTING_WHY_BYTES])
{
    const struct text_token token = text_token(value);
    char *at = strstr(why, value), text[SETTING_WHY_BYTES];
    if (!value[0] || !at || strlen(token.text) >= strlen(value))
        return;
    snprintf(text, sizeof text, "%.*s%s%s", (int)(at - why), why, token.text, at + strlen(value));
    memcpy(why, text, sizeof text);
}

/* Whether a recipe may not set this option. Recipes hold only settings that decide pixels, and the
   path of an environment, which repeat_read checks. */
static bool is_left(const struct setting *option, bool is_setting)
{
    return !is_setting || option->change == SETTING_RUN || option->of_machine ||
           (option->trusted && strcmp(option->name, "environment") != 0);
}

static void take(struct cli_reader *reader, const struct setting *option, void *own,
                 struct settings *settings)
{
    char why[SETTING_WHY_BYTES];
    bool is_setting = !is_own(reader->command, option);
    if (reader->left && is_left(option, is_setting)) {
        size_t used = strlen(reader->left);
        if (is_setting) /* an option of the command itself, such as -o, is dropped without a word */
            snprintf(reader->left + used, reader->left_bytes - used, " --%s", option->name);
        return;
    }
    bool is_barred = !reader->trusted && (!is_setting || (option->trusted && !reader->takes_files));
    if (reader->where && !reader->left && is_barred) {
        /* A file of settings must not extend which files may be read. */
        cli_misuse(reader, "--%s is nothing to be saved", option->name);
        return;
    }
    if (reader->where && reader->value && strlen(reader->value) > SETTING_PATH_BYTES) {
        cli_misuse(reader, "--%s: %zu bytes are too long", option->name, strlen(reader->value));
        return;
    }
    if (is_setting ? settings_read(option, reader->value, settings, why)
                   : setting_read(option, reader->value, own, why))
        return;
    if (reader->where && reader->value)
        shorten(reader->value, why);
    cli_misuse(reader, "--%s%s", option->name, why);
}

/* ---- Files that are written ---- */

static bool are_same(const struct stat *a, const struct stat *b)
{
    return a->st_dev == b->st_dev && a->st_ino == b->st_ino;
}

/* Whether both names, of files that need not exist yet, mean one entry of one folder. */
static bool are_one_entry(const char *a, const char *b)
{
    struct stat first, second;
    char *folders[2] = {path_folder(a), path_folder(b)};
    bool same = folders[0] && folders[1] && strcmp(path_name(a), path_name(b)) == 0 &&
                stat(folders[0][0] ? folders[0] : ".", &first) == 0 &&
                stat(folders[1][0] ? folders[1] : ".", &second) == 0 && are_same(&first, &second);
    free(folders[0]);
    free(folders[1]);
    return same;
}

bool cli_same_file(const char *a, const char *b)
{
    struct stat first, second;
    if (strcmp(a, b) == 0)
        return strcmp(a, "/dev/null") != 0;
    if (stat(a, &first) != 0 || stat(b, &second) != 0)
        return are_one_entry(a, b);
    return S_ISREG(first.st_mode) && are_same(&first, &second);
}

size_t cli_find_marks(const char *pattern, size_t *length)
{
    const char *slash = strrchr(pattern, '/');
    const char *last = strrchr(slash ? slash : pattern, '#');
    *length = 0;
    if (!last)
        return 0;
    const char *first = last;
    while (first > pattern && first[-1] == '#')
        --first;
    *length = (size_t)(last - first) + 1;
    return (size_t)(first - pattern);
}

/* Whether `path` is a name that numbers in place of the `#` of `pattern` may give, or another
   pattern of such names. */
static bool is_numbered(const char *pattern, const char *path)
{
    size_t hashes, before = cli_find_marks(pattern, &hashes);
    if (hashes == 0 || strncmp(pattern, path, before) != 0)
        return false;
    size_t digits = strspn(path + before, "#0123456789");
    return digits > 0 && strcmp(path + before + digits, pattern + before + hashes) == 0;
}

bool cli_check_apart(struct cli_reader *reader, const struct cli_file *files, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i) {
        for (uint32_t k = 0; k < i; ++k) {
            const struct cli_file *a = &files[k], *b = &files[i];
            if ((a->written || b->written) && a->path && b->path && !is_input(b->path) &&
                (cli_same_file(a->path, b->path) || (a->written && is_numbered(a->path, b->path)) ||
                 (b->written && is_numbered(b->path, a->path))))
                return cli_misuse(reader, "%s: %s and %s name the same file", b->path, a->name,
                                  b->name);
        }
    }
    return true;
}

/* Refuses options that would write over a file that the command reads, or over each other's. */
static bool check_files(struct cli_reader *reader, const void *own, const struct settings *settings)
{
    enum { OPTIONS_OF_FILES_MAX = 16, NAME_BYTES = 32 };
    struct cli_file files[CLI_OTHERS_MAX + OPTIONS_OF_FILES_MAX];
    char names[OPTIONS_OF_FILES_MAX][NAME_BYTES], *name = names[0];
    const char *shader = settings ? settings->shader : "",
               *sky = settings ? settings->environment : "";
    uint32_t count = 0;
    /* Help names the arguments: `[SCENE] [options]`, `A B [options]`, `[BENCH] [MODEL...]`. */
    char first[NAME_BYTES] = "", second[NAME_BYTES] = "";
    const char *words = reader->command->arguments;
    if (sscanf(words + (words[0] == '['), "%31[A-Z]%*[] []%31[A-Z]", first, second) < 2)
        memcpy(second, first, sizeof second);
    if (strcmp(first, "BENCH") != 0)
        files[count++] = (struct cli_file){first, reader->positional, false};
    for (uint32_t i = 0; strcmp(first, "SUITE") != 0 && i < reader->other_count; ++i)
        files[count++] = (struct cli_file){second, reader->others[i], false};
    for (const struct setting *row = reader->command->options; row->name; ++row) {
        if (row->kind != SETTING_NAME ||
            !(strstr(row->argument, "FILE") || strcmp(row->argument, "PICTURE") == 0))
            continue;
        const char *path;
        memcpy(&path, (const char *)own + row->offset, sizeof path);
        snprintf(name, NAME_BYTES, row->letter == 'o' ? "-o" : "--%s", row->name);
        files[count++] = (struct cli_file){name, path, row->written};
        name += NAME_BYTES;
    }
    files[count++] = (struct cli_file){"--shader", shader[0] ? shader : NULL, false};
    files[count++] = (struct cli_file){"--environment", sky[0] ? sky : NULL, false};
    return cli_check_apart(reader, files, count);
}

bool cli_read(struct cli_reader *reader, void *own, struct settings *settings)
{
    const struct setting *option;
    while ((option = next(reader)) != NULL)
        take(reader, option, own, settings);
    return reader->status < 0 && (!own || check_files(reader, own, settings));
}

bool cli_no_dash(struct cli_reader *reader, const char *option, const char *path, const char *hint)
{
    return !path || strcmp(path, "-") != 0 || cli_misuse(reader, "%s -: %s", option, hint);
}

bool cli_check_writable(struct cli_reader *reader, const char *path)
{
    if (!path || cli_can_write(path))
        return true;
    reader->status = EXIT_USAGE;
    return false;
}

bool cli_check_output(struct cli_reader *reader, const char *option, const char *path,
                      const char *hint)
{
    return cli_no_dash(reader, option, path, hint) && cli_check_writable(reader, path);
}

/* ---- Words of a file ---- */

/* Decodes the bytes of a word such as $'\x1b\x5b' into `to`. *from is behind the first quote, then
   at the last one. Returns the end of the bytes. */
static char *read_bytes(char **from, char *to)
{
    unsigned byte;
    for (int length = 0; sscanf(*from, "\\x%2x%n", &byte, &length) == 1 && byte; *from += length)
        *to++ = (char)byte;
    return to;
}

char *cli_next_word(char **at, bool *whole)
{
    char *from = *at + strspn(*at, " \t\r\n"), *to = from, *word = from;
    char quote = '\0';
    if (!*from)
        return NULL;
    for (; *from && (quote || !strchr(" \t\r\n", *from)); ++from) {
        if (*from == '$' && from[1] == '\'' && !quote) {
            from += 2;
            to = read_bytes(&from, to);
            *whole = *from == '\'';
            if (!*whole)
                return word;
            continue;
        }
        if (*from == quote || (!quote && (*from == '\'' || *from == '"'))) {
            quote = quote ? '\0' : *from;
            continue;
        }
        bool keeps = quote == '"' ? from[1] && strchr("\"\\$`", from[1]) : !quote && from[1];
        if (*from == '\\' && keeps)
            ++from;
        *to++ = *from;
    }
    *whole = !quote;
    *at = *from ? from + 1 : from;
    *to = '\0';
    return word;
}

char *cli_line(int argc, char **argv)
{
    char *line = NULL;
    size_t bytes;
    FILE *to = open_memstream(&line, &bytes);
    if (!to)
        return NULL;
    fputs("whit", to);
    for (int i = 0; i < argc; ++i) {
        fputc(' ', to);
        quote_print(argv[i], to);
    }
    if (fclose(to) == 0)
        return line;
    free(line);
    return NULL;
}

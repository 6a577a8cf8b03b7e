/* A thin table-driven layer over getopt_long, so that help and parser cannot drift apart. */
#define _GNU_SOURCE
#include "app/cli.h"

#include <ctype.h>
#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "settings/values.h"

enum { OPTIONS_MAX = 96, ID_HELP = 'h', ID_HELP_ALL = CLI_DEVELOPER - 1, HELP_COLUMN = 27 };

/* Behind those of a command. */
static const struct cli_option help_options[] = {
    {ID_HELP, "help", NULL, "print this help", NULL},
    {ID_HELP_ALL, "help-all", NULL, "and the options for those who work on whit", NULL},
};

static bool takes_value(const struct cli_option *option)
{
    return option->value || option->values;
}

const char *cli_argument_name(const struct cli_option *option, char *text, size_t text_bytes)
{
    if (!option->value && option->values)
        return value_list(option->values, "|", text, text_bytes);
    return option->value ? option->value : "";
}

static uint32_t count_options(const struct cli_command *command)
{
    uint32_t count = 0;
    while (command->options[count].name)
        ++count;
    return count;
}

static bool has_developers(const struct cli_command *command)
{
    uint32_t count = count_options(command);
    return count && command->options[count - 1].id >= CLI_DEVELOPER;
}

const struct cli_option *cli_option_at(const struct cli_command *command, uint32_t i)
{
    uint32_t count = count_options(command);
    if (i < count)
        return &command->options[i];
    return i - count < (has_developers(command) ? 2 : 1) ? &help_options[i - count] : NULL;
}

static const struct cli_option *find_option(const struct cli_command *command, int id)
{
    const struct cli_option *option;
    for (uint32_t i = 0; (option = cli_option_at(command, i)); ++i) {
        if (option->id == id)
            return option;
    }
    return NULL;
}

void cli_reader_init(struct cli_reader *reader, const struct cli_command *command, int argc,
                     char **argv)
{
    *reader = (struct cli_reader){.command = command, .argc = argc, .argv = argv, .status = -1};
    optind = 0; /* from the beginning, whatever was read before */
    opterr = 0;
}

/* Words of a file are quoted up to 40 bytes, those of the command line whole. */
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
    const struct cli_option *option;
    *shorts++ = '-'; /* arguments that are no options come in their place, as id 1 */
    *shorts++ = ':';
    for (uint32_t i = 0; (option = cli_option_at(command, i)) && i + 1 < OPTIONS_MAX; ++i) {
        table[i] = (struct option){
            .name = option->name,
            .has_arg = option->id == CLI_GONE ? optional_argument
                       : takes_value(option)  ? required_argument
                                              : no_argument,
            .val = option->id,
        };
        table[i + 1] = (struct option){0};
        if (option->id < 128 && isalpha(option->id)) {
            *shorts++ = (char)option->id;
            if (takes_value(option))
                *shorts++ = ':';
        }
    }
    *shorts = 0;
    return table;
}

/* The word in argv that getopt did not understand. */
static void unknown_option(struct cli_reader *reader)
{
    if (optopt > 0 && optopt < 128 && isprint(optopt) && !find_option(reader->command, optopt)) {
        cli_misuse(reader, "there is no option `-%c`", optopt);
        return;
    }
    const char *word = reader->argv[optind - 1];
    if (optopt) { /* --quiet=3 */
        const struct cli_option *option = find_option(reader->command, optopt);
        cli_misuse(reader, "option `--%s` takes no value", option ? option->name : word);
        return;
    }
    char name[64] = "";
    if (strncmp(word, "--", 2) == 0)
        snprintf(name, sizeof name, "%.*s", (int)strcspn(word + 2, "="), word + 2);
    const char *names[OPTIONS_MAX];
    uint32_t count = 0;
    for (const struct cli_option *option = reader->command->options; option->name; ++option) {
        if (option->id != CLI_GONE && count < OPTIONS_MAX)
            names[count++] = option->name;
    }
    const char *nearest = cli_nearest(name, names, count);
    if (nearest)
        cli_misuse(reader, "there is no option `--%s`; did you mean `--%s`?", name, nearest);
    else
        cli_misuse(reader, "there is no option `%s`", word);
}

static int take_positional(struct cli_reader *reader, const char *word)
{
    const char **place = &reader->positional;
    if (reader->command->takes_two && reader->positional)
        place = &reader->second;
    if (reader->command->takes_many && reader->positional && reader->other_count < CLI_OTHERS_MOST)
        place = &reader->others[reader->other_count++];
    if (*place) {
        cli_misuse(reader, "`%s` is one argument too many", word);
        return 0;
    }
    *place = word;
    return 1;
}

int cli_next(struct cli_reader *reader)
{
    struct option table[OPTIONS_MAX];
    char shorts[2 * OPTIONS_MAX + 3];
    long_options(reader->command, table, shorts);
    while (!reader->done) {
        optopt = 0;
        int place = 0;
        int id = getopt_long(reader->argc, reader->argv, shorts, table, &place);
        if (id == 1) {
            take_positional(reader, optarg);
        } else if (id == -1) {
            while (optind < reader->argc && take_positional(reader, reader->argv[optind]))
                ++optind;
            reader->done = true;
        } else if (id == ':') {
            const struct cli_option *option = find_option(reader->command, optopt);
            char argument[80] = "?";
            cli_misuse(reader, "option `--%s` needs a value: %s", option ? option->name : "?",
                       option ? cli_argument_name(option, argument, sizeof argument) : argument);
        } else if (id == CLI_GONE) {
            const struct cli_option *gone = cli_option_at(reader->command, (uint32_t)place);
            cli_misuse(reader, "option `--%s` %s", gone->name, gone->help);
        } else if (id == '?') {
            unknown_option(reader);
        } else if ((id == ID_HELP || id == ID_HELP_ALL) && reader->where) {
            cli_misuse(reader, "--help is for the command line alone");
        } else if (id == ID_HELP || id == ID_HELP_ALL) {
            cli_print_help(reader->command, id == ID_HELP_ALL, stdout);
            reader->done = true;
            reader->status = cli_finish_stdout(EXIT_FINE);
        } else {
            reader->option = find_option(reader->command, id);
            reader->value = optarg;
            return id;
        }
    }
    return 0;
}

bool cli_unsigned(struct cli_reader *reader, uint32_t least, uint32_t most, uint32_t *out)
{
    char *end;
    errno = 0;
    unsigned long long value = strtoull(reader->value, &end, 10);
    if (!isdigit((unsigned char)reader->value[0]) || *end || errno || value < least || value > most)
        return cli_misuse(reader, "--%s `%s`: a whole number from %u to %u is needed",
                          reader->option->name, reader->value, least, most);
    *out = (uint32_t)value;
    return true;
}

bool cli_bytes(struct cli_reader *reader, uint64_t *out)
{
    static const char units[] = "KMG";
    char *end;
    errno = 0;
    unsigned long long value = strtoull(reader->value, &end, 10);
    const char *unit = *end ? strchr(units, *end) : NULL;
    int shift = unit ? 10 * (int)(unit - units + 1) : 0;
    if (!isdigit((unsigned char)reader->value[0]) || end[unit != NULL] || errno || value == 0 ||
        value > UINT64_MAX >> shift)
        return cli_misuse(reader, "--%s `%s`: a number of bytes is needed, or one with K, M or G",
                          reader->option->name, reader->value);
    *out = (uint64_t)value << shift;
    return true;
}

bool cli_number(struct cli_reader *reader, double least, double most, double *out)
{
    char *end;
    double value = strtod(reader->value, &end);
    if (end == reader->value || *end || !(value >= least && value <= most))
        return cli_misuse(reader, "--%s `%s`: a number from %g to %g is needed",
                          reader->option->name, reader->value, least, most);
    *out = value;
    return true;
}

enum { SIDE_MAX = 32768 };
static const uint64_t PIXELS_MAX = UINT64_C(1) << 28;

bool cli_size(struct cli_reader *reader, uint32_t *width, uint32_t *height)
{
    unsigned long w = 0, h = 0;
    const char *text = reader->value;
    char *end = NULL;
    bool good = isdigit((unsigned char)text[0]);
    if (good) {
        w = strtoul(text, &end, 10);
        good = (*end == 'x' || *end == 'X') && isdigit((unsigned char)end[1]);
    }
    if (good) {
        h = strtoul(end + 1, &end, 10);
        good = !*end;
    }
    if (!good || w < 1 || h < 1 || w > SIDE_MAX || h > SIDE_MAX || (uint64_t)w * h > PIXELS_MAX)
        return cli_misuse(reader, "--%s `%s`: WxH is needed, each from 1 to %d, such as 1280x720",
                          reader->option->name, text, SIDE_MAX);
    *width = (uint32_t)w;
    *height = (uint32_t)h;
    return true;
}

bool cli_choice(struct cli_reader *reader, int *out)
{
    const struct setting_value *values = reader->option->values;
    char list[256];
    uint32_t found = value_find(values, reader->value);
    if (found == WHIT_NONE)
        return cli_misuse(reader, "--%s `%s`: one of %s is needed", reader->option->name,
                          reader->value, value_list(values, ", ", list, sizeof list));
    *out = values[found].value;
    return true;
}

bool cli_choice_unsigned(struct cli_reader *reader, uint32_t *out)
{
    int value;
    bool good = cli_choice(reader, &value);
    if (good)
        *out = (uint32_t)value;
    return good;
}

bool cli_no_dash(struct cli_reader *reader, const char *option, const char *path, const char *hint)
{
    return !path || strcmp(path, "-") != 0 || cli_misuse(reader, "%s -: %s", option, hint);
}

static void print_option(const struct cli_option *option, FILE *to)
{
    char left[120], argument[80];
    char letter[8] = "    ";
    if (option->id < 128 && isalpha(option->id))
        snprintf(letter, sizeof letter, "-%c, ", option->id);
    snprintf(left, sizeof left, "  %s--%s%s%s", letter, option->name,
             takes_value(option) ? " " : "", cli_argument_name(option, argument, sizeof argument));
    if (strlen(left) + 2 > HELP_COLUMN)
        fprintf(to, "%s\n%*s", left, HELP_COLUMN, "");
    else
        fprintf(to, "%-*s", HELP_COLUMN, left);
    for (const char *line = option->help; *line;) {
        size_t length = strcspn(line, "\n");
        fprintf(to, "%.*s\n", (int)length, line);
        line += length + (line[length] != 0);
        if (*line)
            fprintf(to, "%*s", HELP_COLUMN, "");
    }
}

void cli_print_help(const struct cli_command *command, bool all, FILE *to)
{
    const struct cli_option *option;
    fprintf(to, "usage: whit %s %s\n\n%s\n\noptions:\n", command->name, command->arguments,
            command->summary);
    for (uint32_t i = 0; (option = cli_option_at(command, i)); ++i) {
        if (option->id != CLI_GONE && (all || option->id < CLI_DEVELOPER))
            print_option(option, to);
    }
    if (command->details)
        fprintf(to, "\n%s", command->details);
}

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

const char *cli_nearest(const char *word, const char *const *names, uint32_t count)
{
    const char *nearest = NULL;
    size_t length = strlen(word);
    uint32_t least = length <= 3 ? 1 : length <= 6 ? 2 : 3;
    if (length == 0 || length > WORD_MAX)
        return NULL;
    for (uint32_t i = 0; i < count; ++i) {
        if (strlen(names[i]) > WORD_MAX || !names[i][0])
            continue;
        uint32_t steps = distance(word, names[i]);
        bool prefix = strncmp(word, names[i], length) == 0;
        if (steps <= least || (prefix && !nearest)) {
            nearest = names[i];
            least = steps < least ? steps : least;
        }
    }
    return nearest;
}

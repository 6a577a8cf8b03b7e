/* Prints options for shells, docs/cli.md and manual pages. Reads them through cli_option_at, as
   --help does. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "app/arguments.h"
#include "app/describe.h"
#include "base/file.h"

/* ---- Completion ---- */

static void print_word(const char *word, const char *about)
{
    printf("%s\t%.*s\n", word, (int)strcspn(about, "\n"), about);
}

static void print_options(const struct cli_command *command)
{
    const struct setting *option;
    char word[80];
    for (uint32_t i = 0; (option = cli_option_at(command, i)); ++i) {
        snprintf(word, sizeof word, "--%s", option->name);
        if (option->kind != SETTING_GONE)
            print_word(word, option->help);
    }
}

/* Prints the words that an option accepts; prints nothing for numbers and files. */
static void print_values(const struct cli_command *command, const char *name)
{
    const struct setting *option;
    const char *word;
    name += strspn(name, "-");
    for (uint32_t i = 0; (option = cli_option_at(command, i)); ++i) {
        if (strcmp(option->name, name) != 0 || option->kind == SETTING_GONE)
            continue;
        for (uint32_t k = 0; option->values && option->values[k].word; ++k)
            print_word(option->values[k].word, "");
        for (uint32_t k = 0; command->word && (word = command->word(name, k)); ++k)
            print_word(word, "");
    }
}

int describe_complete(const struct cli_command *const *commands, uint32_t count,
                      const char *const *words)
{
    const char *name = words[0];
    bool known = false;
    for (uint32_t i = 0; name && i < count; ++i)
        known |= strcmp(commands[i]->name, name) == 0;
    if (name && !known && file_exists(name))
        name = "view"; /* a file in place of a command */
    for (uint32_t i = 0; i < count; ++i) {
        if (!name)
            print_word(commands[i]->name, commands[i]->summary);
        else if (strcmp(commands[i]->name, name) == 0 && !words[1])
            print_options(commands[i]);
        else if (strcmp(commands[i]->name, name) == 0)
            print_values(commands[i], words[1]);
    }
    return cli_finish_stdout(EXIT_FINE);
}

/* ---- The table of docs/cli.md ---- */

enum { HELP_MAX = 1024 };

static void put_cell(const char *text)
{
    for (; *text; ++text) {
        if (*text == '|')
            putchar('\\');
        putchar(*text == '\n' ? ' ' : *text);
    }
}

/* Whether the command takes the option with exactly this help. */
static bool takes_as_is(const struct cli_command *command, const struct setting *option,
                        const char *help)
{
    const struct setting *own;
    char other[HELP_MAX];
    uint32_t i = 0;
    while ((own = cli_option_at(command, i)) && own != option)
        ++i;
    return own && strcmp(cli_help(command, option, other, sizeof other), help) == 0;
}

/* Prints one row of the table, for all commands that take the option with exactly the same help. */
static void print_row(const struct cli_command *const *commands, uint32_t count, uint32_t first,
                      const struct setting *option)
{
    char list[80], help[HELP_MAX];
    const char *argument = cli_argument_name(option, list, sizeof list);
    cli_help(commands[first], option, help, sizeof help);
    for (uint32_t i = 0; i < first; ++i) {
        if (takes_as_is(commands[i], option, help))
            return;
    }
    fputs("| ", stdout);
    if (option->letter)
        printf("`-%c`, ", option->letter);
    printf("`--%s%s", option->name, argument[0] ? " " : "");
    put_cell(argument);
    fputs("` |", stdout);
    for (uint32_t i = first; i < count; ++i) {
        if (takes_as_is(commands[i], option, help))
            printf(" %s", commands[i]->name);
    }
    fputs(option->developer ? ", `--help-all` | " : " | ", stdout);
    put_cell(help);
    puts(" |");
}

int describe_table(const struct cli_command *const *commands, uint32_t count)
{
    const struct setting *option;
    puts("| option | commands | meaning |\n|---|---|---|");
    for (uint32_t c = 0; c < count; ++c) {
        for (uint32_t i = 0; (option = cli_option_at(commands[c], i)); ++i) {
            if (option->kind != SETTING_GONE && option->kind != SETTING_HELP)
                print_row(commands, count, c, option);
        }
    }
    return cli_finish_stdout(EXIT_FINE);
}

/* ---- Manual pages ---- */

/* Prints text with all characters escaped that are special to troff. */
static void put_text(FILE *to, const char *text)
{
    for (bool begins = true; *text; begins = *text++ == '\n') {
        if (begins && (*text == '.' || *text == '\''))
            fputs("\\&", to);
        if (*text == '\\' || *text == '-')
            fputs(*text == '-' ? "\\-" : "\\e", to);
        else
            fputc(*text, to);
    }
}

static void put_head(FILE *to, const char *name, const char *summary)
{
    fputs(".TH ", to);
    for (const char *at = name; *at; ++at)
        fputc(toupper((unsigned char)*at), to);
    fprintf(to, " 1 \"\" \"whit %s\"\n.SH NAME\n", WHIT_VERSION);
    put_text(to, name);
    fputs(" \\- ", to);
    put_text(to, summary);
    fputs("\n.SH SYNOPSIS\n", to);
}

static void put_option(FILE *to, const struct cli_command *command, const struct setting *option)
{
    char list[80], text[200], help[HELP_MAX], letter[8] = "";
    const char *argument = cli_argument_name(option, list, sizeof list);
    if (option->letter)
        snprintf(letter, sizeof letter, "-%c, ", option->letter);
    fputs(".TP\n.B ", to);
    snprintf(text, sizeof text, "%s--%s%s%s", letter, option->name, argument[0] ? " " : "",
             argument);
    put_text(to, text);
    fputc('\n', to);
    put_text(to, cli_help(command, option, help, sizeof help));
    fputc('\n', to);
}

static void put_command(FILE *to, const struct cli_command *command)
{
    const struct setting *option;
    char name[64];
    snprintf(name, sizeof name, "whit-%s", command->name);
    put_head(to, name, command->summary);
    fprintf(to, ".B whit %s\n", command->name);
    put_text(to, command->arguments);
    fputs("\n.SH OPTIONS\n", to);
    for (uint32_t i = 0; (option = cli_option_at(command, i)); ++i) {
        if (option->kind != SETTING_GONE)
            put_option(to, command, option);
    }
    if (command->details) {
        fputs(".SH DESCRIPTION\n.nf\n", to);
        put_text(to, command->details);
        fputs(".fi\n", to);
    }
    fputs(".SH SEE ALSO\n.BR whit (1)\n", to);
}

const char *const describe_file =
    "A scene or model alone is shown where there is a display, and rendered to a .png where there\n"
    "is none.\n";

static void put_program(FILE *to, const struct cli_command *const *commands, uint32_t count)
{
    put_head(to, "whit", "a Whitted ray tracer on Vulkan compute");
    fputs(".B whit\nCOMMAND [options]\n.br\n.B whit\nFILE [options]\n.SH DESCRIPTION\n", to);
    put_text(to, describe_file);
    fputs("A command or option that is not known, bad input and output that cannot be written end "
          "with exit code 2;\nall exit codes are in docs/cli.md.\n.SH COMMANDS\n",
          to);
    for (uint32_t i = 0; i < count; ++i) {
        fprintf(to, ".TP\n.BR whit\\-%s (1)\n", commands[i]->name);
        put_text(to, commands[i]->summary);
        fputc('\n', to);
    }
}

int describe_manual(const struct cli_command *const *commands, uint32_t count, const char *folder)
{
    for (uint32_t i = 0; i <= count; ++i) {
        char path[1024];
        char *text = NULL;
        size_t size;
        FILE *to = open_memstream(&text, &size);
        snprintf(path, sizeof path, "%s/whit%s%s.1", folder, i ? "-" : "",
                 i ? commands[i - 1]->name : "");
        if (to && i)
            put_command(to, commands[i - 1]);
        else if (to)
            put_program(to, commands, count);
        whit_result result = !to || fclose(to) != 0 ? WHIT_ERROR_MEMORY
                                                    : file_write_whole(&cli_log, path, text, size);
        free(text);
        if (result != WHIT_OK)
            return cli_exit_of(result);
    }
    return EXIT_FINE;
}

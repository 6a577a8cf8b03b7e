/* whit: the command line over libwhit. */
#include <string.h>

#include "app/commands.h"
#include "app/describe.h"
#include "base/text.h"

static const struct cli_command *const commands[] = {
    &command_render, &command_scene, &command_trace,   &command_probe, &command_bvh,
    &command_bench,  &command_hard,  &command_compare, &command_cost,  &command_devices,
#ifdef WHIT_VIEWER
    &command_view,
#endif
};
enum { COMMAND_COUNT = sizeof commands / sizeof commands[0] };

static void print_usage(FILE *to)
{
    fputs("usage: whit COMMAND [options]\n\nA Whitted ray tracer on Vulkan compute.\n\ncommands:\n",
          to);
    for (uint32_t i = 0; i < COMMAND_COUNT; ++i)
        fprintf(to, "  %-9s %s\n", commands[i]->name, commands[i]->summary);
    fputs("\noptions:\n"
          "  -h, --help     print this help; `whit COMMAND --help` explains a command\n"
          "      --version  print the version\n",
          to);
}

static const struct cli_command *find_command(const char *name)
{
    for (uint32_t i = 0; i < COMMAND_COUNT; ++i) {
        if (strcmp(commands[i]->name, name) == 0)
            return commands[i];
    }
    return NULL;
}

static int refuse(const char *word)
{
    const char *names[COMMAND_COUNT];
    for (uint32_t i = 0; i < COMMAND_COUNT; ++i)
        names[i] = commands[i]->name;
    const char *kind = word[0] == '-' ? "option" : "command";
    const char *nearest = text_nearest(word, names, COMMAND_COUNT);
    if (nearest)
        cli_error("there is no %s `%s`; did you mean `whit %s`? (see `whit --help`)", kind, word,
                  nearest);
    else
        cli_error("there is no %s `%s` (see `whit --help`)", kind, word);
    return EXIT_USAGE;
}

int main(int argc, char **argv)
{
    const char *word = argc > 1 ? argv[1] : NULL;
    if (!word) {
        print_usage(stderr);
        return EXIT_USAGE;
    }
    if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0) {
        print_usage(stdout);
        return cli_finish_stdout(EXIT_FINE);
    }
    if (strcmp(word, "--version") == 0) {
        puts("whit " WHIT_VERSION);
        return cli_finish_stdout(EXIT_FINE);
    }
    if (strcmp(word, "--complete") == 0)
        return describe_complete(commands, COMMAND_COUNT, (const char *const *)argv + 2);
    if (strcmp(word, "--options") == 0)
        return describe_table(commands, COMMAND_COUNT);
    if (strcmp(word, "--manual") == 0 && argc == 3)
        return describe_manual(commands, COMMAND_COUNT, argv[2]);
    const struct cli_command *command = find_command(word);
    if (!command)
        return refuse(word);
    cli_catch_interrupts();
    return command->run(command, argc - 1, argv + 1);
}

/* whit: the command line over libwhit. */
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/commands.h"
#include "app/describe.h"
#include "base/input.h"
#include "base/text.h"

static const struct cli_command *const commands[] = {
    &command_render, &command_scene, &command_trace,   &command_probe, &command_bvh,
    &command_bench,  &command_hard,  &command_compare, &command_cost,  &command_devices,
    &command_shader, &command_check, &command_merge,   &command_batch,
#ifdef WHIT_VIEWER
    &command_view,
#endif
};
enum { COMMAND_COUNT = sizeof commands / sizeof commands[0] };

static void print_usage(FILE *to)
{
    fputs("usage: whit COMMAND [options]\n       whit FILE [options]\n\nA Whitted ray tracer on "
          "Vulkan compute.\n\ncommands:\n",
          to);
    for (uint32_t i = 0; i < COMMAND_COUNT; ++i)
        fprintf(to, "  %-9s %s\n", commands[i]->name, commands[i]->summary);
    fprintf(to,
            "\n%s\noptions:\n"
            "  -h, --help     print this help; `whit COMMAND --help` explains a command\n"
            "      --version  print the version\n",
            describe_file);
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
    const char *kind = word[0] == '-' ? "option" : "command or file";
    const char *nearest = text_nearest(word, names, COMMAND_COUNT);
    if (nearest)
        cli_error("there is no %s `%s`; did you mean `whit %s`? (see `whit --help`)", kind, word,
                  nearest);
    else
        cli_error("there is no %s `%s` (see `whit --help`)", kind, word);
    return EXIT_USAGE;
}

/* ---- A file in place of a command ---- */

static bool is_file(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && !S_ISDIR(info.st_mode);
}

static bool has_display(void)
{
#ifdef WHIT_VIEWER
    const char *x = getenv("DISPLAY"), *wayland = getenv("WAYLAND_DISPLAY");
    return (x && x[0]) || (wayland && wayland[0]);
#else
    return false;
#endif
}

/* Names the picture for `folder/model.glb`: model.png in the working folder. False: this file
   exists already. */
static bool name_picture(const char *path, char *out, size_t bytes)
{
    if (is_input(path))
        path = "stdin";
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    int length = dot && dot > name ? (int)(dot - name) : (int)strlen(name);
    snprintf(out, bytes, "%.*s.png", length, name);
    return !is_file(out);
}

/* Whether options behind the file say where the picture goes. */
static bool names_output(int argc, char **argv)
{
    for (int i = 2; i < argc; ++i) {
        const char *word = argv[i];
        if (word[0] == '-' && /* -qo is -q and -o */
            (strncmp(word, "--o", 3) == 0 || word[1 + strspn(word + 1, "qh")] == 'o'))
            return true;
    }
    return false;
}

/* Runs `whit FILE [options]` or `whit -` as `whit view` where there is a display, and as `whit
   render` where there is none. */
static int open_file(int argc, char **argv)
{
    char picture[4096], render[] = "render", output[] = "-o", view[] = "view";
    char **words = calloc((size_t)argc + 4, sizeof *words);
    bool shows = has_display();
    int count = 0;
    if (!words)
        return cli_exit_of(WHIT_ERROR_MEMORY);
    words[count++] = shows ? view : render;
    for (int i = 1; i < argc; ++i)
        words[count++] = argv[i];
    if (!shows && !names_output(argc, argv)) {
        if (!name_picture(argv[1], picture, sizeof picture)) {
            free(words);
            return CLI_FAIL(EXIT_USAGE,
                            "there is no display, and `%s` is there already: name another by "
                            "`whit render %s -o FILE`",
                            picture, argv[1]);
        }
        cli_note("there is no display: rendering %s", picture);
        words[count++] = output;
        words[count++] = picture;
    }
    cli_catch_interrupts();
    const struct cli_command *command = find_command(words[0]);
    int status = command->run(command, count, words);
    free(words);
    return status;
}

int main(int argc, char **argv)
{
    const char *word = argc > 1 ? argv[1] : NULL;
    /* With standard input closed, the next file that is opened would become it. */
    if (fcntl(STDIN_FILENO, F_GETFD) < 0)
        (void)!open("/dev/null", O_RDONLY);
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
    if (!command && (is_file(word) || is_input(word)))
        return open_file(argc, argv);
    if (!command)
        return refuse(word);
    cli_catch_interrupts();
    return command->run(command, argc - 1, argv + 1);
}

#include "app/render/repeat.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/arguments.h"
#include "app/commands.h"
#include "app/render/recipe.h"
#include "base/input.h"
#include "base/path.h"
#include "base/roots.h"
#include "base/text.h"

enum { WORDS_MAX = 256, COMMAND_BYTES = 16384, LEFT_BYTES = 256, SAID_BYTES = 1024 };

/* A picture and the recipe read from it. */
struct recipe_read {
    const char *picture;
    whit_text *texts;
    uint32_t text_count;
    char *command;         /* cut into words */
    char left[LEFT_BYTES]; /* " --NAME --NAME": options in its recipe that recipes may not set */
};

const char *repeat_picture(const struct cli_reader *reader, const struct repeat *repeat)
{
    if (repeat->picture || !reader->positional || is_input(reader->positional))
        return repeat->picture;
    bool is_picture = path_is(reader->positional, "png") || path_is(reader->positional, "exr");
    return is_picture ? reader->positional : NULL;
}

/* ---- The command in it ---- */

static bool split(struct recipe_read *recipe, const char *command, char *argv[], int *argc)
{
    bool whole = true;
    *argc = 0;
    recipe->command = strlen(command) < COMMAND_BYTES ? strdup(command) : NULL;
    char *at = recipe->command, *word;
    while (at && whole && *argc < WORDS_MAX && (word = cli_next_word(&at, &whole)) != NULL)
        argv[(*argc)++] = word;
    argv[*argc] = NULL;
    bool good = at && whole && *argc < WORDS_MAX && *argc >= 3 && strcmp(argv[0], "whit") == 0 &&
                strcmp(argv[1], "render") == 0;
    if (!good)
        cli_error("%s: its recipe is none of whit's, or is damaged", recipe->picture);
    return good;
}

static bool read_command(struct recipe_read *recipe, const char *command, struct settings *settings)
{
    char *argv[WORDS_MAX + 1], said[SAID_BYTES], why[SETTING_WHY_BYTES];
    struct cli_reader reader;
    int argc;
    if (!split(recipe, command, argv, &argc))
        return false;
    cli_reader_init(&reader, &command_render, argc - 1, argv + 1);
    reader.where = recipe->picture;
    reader.said = said;
    reader.said_bytes = sizeof said;
    reader.left = recipe->left;
    reader.left_bytes = sizeof recipe->left;
    *settings = settings_usual();
    if (!cli_read(&reader, NULL, settings))
        return CLI_FAIL(false, "%s", said);
    if (!settings_check(settings, why))
        return CLI_FAIL(false, "%s: %s", recipe->picture, why);
    const char *scene = reader.positional ? reader.positional : "";
    if (!scene[0] || strlen(scene) >= sizeof settings->scene)
        return CLI_FAIL(false, "%s: its recipe has no scene", recipe->picture);
    memcpy(settings->scene, scene, strlen(scene) + 1);
    return true;
}

/* ---- What it names ---- */

/* Resolves `path`, a file name in the recipe, which is relative to the picture, into one relative
   to the working folder. Gives NULL, or the reason why the file may not be opened. */
static const char *find_file(const char *picture, char *path, size_t path_bytes)
{
    struct roots roots;
    const char *why = "out of memory";
    if (is_input(path))
        return "it came by standard input";
    /* ./ in front of a folder would be in front of it once more in each repetition. */
    bool below = path_name(picture) != picture && strncmp(path, "./", 2) == 0;
    char *beside = path_beside(picture, path + (below ? 2 : 0));
    if (beside && roots_init(&roots, picture) == WHIT_OK) {
        errno = 0;
        enum reach reach = is_input(beside) ? REACH_NOT_A_FILE : roots_reach(&roots, beside);
        why =
            reach == REACH_OUTSIDE ? "it lies outside of the picture's folder" : reach_words(reach);
        roots_finish(&roots);
    }
    if (beside && !why && strlen(beside) >= path_bytes)
        why = "its path is too long";
    if (!why)
        strcpy(path, beside);
    free(beside);
    return why;
}

static bool find_scene(const struct recipe_read *recipe, struct settings *settings,
                       const char *command)
{
    const char *why = find_file(recipe->picture, settings->scene, sizeof settings->scene);
    if (why)
        cli_error("%s: its scene `%s`: %s; name it: `whit %s SCENE --recipe %s`", recipe->picture,
                  settings->scene, why, command, recipe->picture);
    return !why;
}

static bool find_others(const struct recipe_read *recipe, struct settings *settings)
{
    const char *why = settings->environment[0] ? find_file(recipe->picture, settings->environment,
                                                           sizeof settings->environment)
                                               : NULL;
    if (why)
        return CLI_FAIL(false, "%s: --environment `%s`: %s", recipe->picture, settings->environment,
                        why);
    if (!settings->shader[0])
        return true;
    if (!text_value(recipe->texts, recipe->text_count, WHIT_SHADER_KEY))
        return CLI_FAIL(false, "%s: the functions that it was made with are not in it",
                        recipe->picture);
    if (strlen(recipe->picture) >= sizeof settings->shader)
        return CLI_FAIL(false, "%s: the path is too long", recipe->picture);
    memcpy(settings->shader_said, settings->shader, sizeof settings->shader_said);
    strcpy(settings->shader, recipe->picture);
    return true;
}

/* ---- Asking ---- */

static uint32_t count_lines(const whit_shader_file *file)
{
    uint32_t lines = 1;
    for (size_t i = 0; i + 1 < file->bytes; ++i)
        lines += file->text[i] == '\n';
    return lines;
}

/* Prints what the picture would load and compile. Its functions were unpacked before without an
   error. */
static void tell(const struct recipe_read *recipe, const struct settings *settings,
                 const whit_shader_file *files, uint32_t count)
{
    fprintf(stderr, "whit: %s would load\n  scene      %s\n", cli_shown(recipe->picture),
            cli_shown(settings->scene));
    if (settings->environment[0])
        fprintf(stderr, "  sky        %s\n", cli_shown(settings->environment));
    for (uint32_t i = 0; i < count; ++i)
        fprintf(stderr, "  %s  %s, %u line%s\n", i ? "         " : "functions",
                cli_shown(files[i].name), count_lines(&files[i]),
                count_lines(&files[i]) == 1 ? "" : "s");
    if (count)
        fprintf(stderr, "             `whit shader extract %s` writes them out\n",
                cli_shown(recipe->picture));
    if (settings->sliders[0])
        fprintf(stderr, "  sliders    %s\n", cli_shown(settings->sliders));
    if (recipe->left[0])
        fprintf(stderr, "  not taken %s: such options count on the command line alone\n",
                cli_shown(recipe->left));
}

static bool ask(const struct recipe_read *recipe)
{
    char answer[16];
    if (!isatty(STDIN_FILENO) || !isatty(STDERR_FILENO))
        return CLI_FAIL(
            false,
            "%s: whit asks before it loads what a picture says, and there is no terminal to "
            "ask at; --yes says yes",
            recipe->picture);
    fprintf(stderr, "Load and compile it? [y/N] ");
    bool yes =
        fgets(answer, sizeof answer, stdin) &&
        (strcmp(answer, "y\n") == 0 || strcmp(answer, "yes\n") == 0 || strcmp(answer, "Y\n") == 0);
    if (!yes)
        cli_error("%s: nothing of it was loaded", recipe->picture);
    return yes;
}

/* Whether the functions that the picture carries are still those that were shown: to be compiled,
   they are read again. */
static bool is_as_shown(const struct recipe_read *recipe, const struct settings *settings)
{
    const char *folders[SETTING_FOLDERS_MAX];
    const whit_load_params params = settings_load(settings, folders);
    const char *shown = text_value(recipe->texts, recipe->text_count, WHIT_SHADER_KEY);
    whit_text *texts;
    uint32_t count;
    if (whit_image_load_texts(recipe->picture, &params, &cli_log, &texts, &count) != WHIT_OK)
        return false;
    const char *now = text_value(texts, count, WHIT_SHADER_KEY);
    bool same = now && strcmp(now, shown) == 0;
    whit_memory_destroy(texts);
    return same || CLI_FAIL(false, "%s: its functions are others than those that were shown",
                            recipe->picture);
}

static bool confirm(const struct recipe_read *recipe, const struct settings *settings, bool yes)
{
    whit_shader_file *files = NULL;
    uint32_t count = 0;
    if (strcmp(settings->shader, recipe->picture) == 0 &&
        whit_shader_unpack(text_value(recipe->texts, recipe->text_count, WHIT_SHADER_KEY),
                           recipe->picture, &cli_log, &files, &count) != WHIT_OK)
        return false;
    if (!yes || !settings->quiet)
        tell(recipe, settings, files, count);
    whit_memory_destroy(files);
    return yes || (ask(recipe) && (count == 0 || is_as_shown(recipe, settings)));
}

/* ---- All of it ---- */

static bool load(struct recipe_read *recipe, const struct job *job, struct settings *settings)
{
    const char *folders[SETTING_FOLDERS_MAX];
    const whit_load_params params = settings_load(&job->settings, folders);
    if (whit_image_load_texts(recipe->picture, &params, &cli_log, &recipe->texts,
                              &recipe->text_count) != WHIT_OK)
        return false;
    const char *command = text_value(recipe->texts, recipe->text_count, "whit:command");
    if (text_value(recipe->texts, recipe->text_count, VIEW_CAMERA_KEY))
        return CLI_FAIL(false,
                        "%s: its camera is one that --camera has no words for; " VIEW_CAMERA_KEY
                        " in its recipe is a line for a file of --cameras",
                        recipe->picture);
    if (!command)
        cli_error("%s: a picture without a recipe of whit's in it", recipe->picture);
    return command && read_command(recipe, command, settings);
}

/* Sets the job's settings to those of the recipe, then reads the command line, which overrides
   them. */
static bool read_over(struct recipe_read *recipe, struct job *job, struct cli_reader *reader,
                      void *own, int argc, char **argv)
{
    const struct cli_command *command = reader->command;
    struct settings settings;
    const char *named = reader->positional;
    bool names_scene = named && strcmp(named, recipe->picture) != 0;
    char scene[SETTING_PATH_BYTES];
    if (!load(recipe, job, &settings) ||
        !(names_scene || find_scene(recipe, &settings, command->name)) ||
        !find_others(recipe, &settings))
        return false;
    memcpy(scene, settings.scene, sizeof scene);
    job_init(job, command);
    job->settings = settings;
    job->settings.given = 0; /* no conflict where the command line repeats an option of the
                                recipe */
    const char *hash = text_value(recipe->texts, recipe->text_count, "whit:scene_hash");
    job->recipe_hash = hash ? strtoull(hash, NULL, 16) : 0;
    const char *part = text_value(recipe->texts, recipe->text_count, PART_KEY);
    snprintf(job->recipe_part, sizeof job->recipe_part, "%s", part ? part : "");
    cli_reader_init(reader, command, argc, argv);
    if (!job_read(job, reader, own, true))
        return false;
    if (!names_scene)
        memcpy(job->settings.scene, scene, sizeof scene);
    memcpy(settings.scene, job->settings.scene, sizeof settings.scene);
    if (!settings_same_scene(&settings, &job->settings))
        job->recipe_hash = 0; /* other options make another scene of the same file */
    if (strcmp(job->settings.shader, recipe->picture) != 0)
        job->settings.shader_said[0] = '\0';
    return true;
}

bool repeat_read(struct job *job, struct cli_reader *reader, void *own, const struct repeat *repeat,
                 int argc, char **argv)
{
    struct recipe_read recipe = {.picture = repeat_picture(reader, repeat)};
    bool yes = repeat->yes;
    bool done =
        read_over(&recipe, job, reader, own, argc, argv) && confirm(&recipe, &job->settings, yes);
    whit_memory_destroy(recipe.texts);
    free(recipe.command);
    if (!done && reader->status < 0)
        reader->status = EXIT_USAGE;
    return done;
}

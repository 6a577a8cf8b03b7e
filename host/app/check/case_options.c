/* Reads a case's scene and options: all settings of `whit render` except those in refused[]. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "app/arguments.h"
#include "app/check/suite.h"
#include "base/array.h"
#include "base/input.h"
#include "base/path.h"
#include "settings/quote.h"

enum { OPTIONS_BYTES = 16384 };

#define REFUSED(option, text)                                                                      \
    {                                                                                              \
        .name = option, .help = text, .kind = SETTING_GONE                                         \
    }
static const char writes[] = "writes a file, which no case may",
                  loosens[] = "loosens a limit, which no case may",
                  of_command[] = "is for `whit check` itself, not for a case",
                  a_part[] = "makes a part: a case is a whole picture",
                  by_time[] = "goes by measured time: no two runs need to agree";

/* Options that a case may not have, each with the reason; a case has the other settings of `whit
   render`. */
static const struct setting refused[] = {
    {.name = "output", .letter = 'o', .help = writes, .kind = SETTING_GONE},
    REFUSED("ids", writes),
    REFUSED("thumbnail", writes),
    REFUSED("stats", writes),
    REFUSED("counters", writes),
    REFUSED("cameras", "makes several pictures: a case is one, with --camera"),
    REFUSED("distances", writes),
    REFUSED("frames", "makes several pictures: a case is one, with --frame"),
    REFUSED("tile", a_part),
    REFUSED("samples-part", a_part),
    REFUSED("resume", a_part),
    REFUSED("refine", by_time),
    REFUSED("fresh", by_time),
    REFUSED("budget-ms", by_time),
    REFUSED("max-error", by_time),
    REFUSED("recipe", "takes options from a picture: write them out"),
    REFUSED("yes", "takes options from a picture: write them out"),
    REFUSED("allow-path", "loosens a limit: a scene may name files below the suite's folder, or "
                          "below that of --root"),
    REFUSED("trust", loosens),
    REFUSED("stages", loosens),
    REFUSED("memory-limit", loosens),
    REFUSED("import-limit", loosens),
    REFUSED("portable", "is always on"),
    REFUSED("require-sandbox", of_command),
    REFUSED("device", of_command),
    REFUSED("no-cache", of_command),
    REFUSED("time-limit", of_command),
    REFUSED("validation", of_command),
    REFUSED("quiet", of_command),
    {0},
};

/* The options of a case are parsed as those of `whit render`, so that messages refer to the help
   of that command. */
static const struct cli_command case_command = {
    .name = "render", .arguments = "", .summary = "", .options = refused, .settings = IN_RENDER};

/* Whether a name leads from the suite's folder down. Other names may come back into this folder,
   but not in a copy of it, such as the tree of --base. */
static bool leads_down(const char *name)
{
    const char *slash = NULL;
    if (name[0] == '/')
        return false;
    do {
        const char *part = slash ? slash + 1 : name;
        if (strcmp(part, "..") == 0 || strncmp(part, "../", 3) == 0)
            return false;
        slash = strchr(part, '/');
    } while (slash);
    return true;
}

/* Resolves a file name in the suite into a path relative to the working folder; false, with the
   reason. */
static bool find_file(const struct suite *suite, const struct check_case *item, const char *option,
                      char *name, size_t name_bytes, struct cli_reader *reader)
{
    char *path = roots_join(suite->roots.named, name);
    errno = 0;
    enum reach reach = path ? roots_reach(&suite->roots, path) : REACH_MISSING;
    bool needed = !suite->needs || suite->needs(suite->user, item->name);
    bool fits = path && strlen(path) < name_bytes;
    bool good = false;
    if (reach == REACH_MISSING && !needed)
        reach = REACH_FILE;
    if (!path)
        cli_misuse(reader, "out of memory");
    else if (is_input(name))
        cli_misuse(reader, "%s`-`: standard input is not the suite's", option);
    else if (reach == REACH_OUTSIDE)
        cli_misuse(reader, "%s`%s`: it lies outside of the suite's folder", option, name);
    else if (needed && !leads_down(name))
        cli_misuse(reader, "%s`%s`: a name from the suite's folder down, without `..`, is needed",
                   option, name);
    else if (reach != REACH_FILE)
        cli_misuse(reader, "%s`%s`: %s", option, name, reach_words(reach));
    else if (!fits)
        cli_misuse(reader, "%s`%s`: its path is too long", option, name);
    else
        good = true;
    if (good)
        strcpy(name, path);
    free(path);
    return good;
}

/* Lets the scene, which is in a folder below the suite's, name files anywhere below the suite's. */
static bool allow_folder(struct settings *settings, const struct suite *suite,
                         struct cli_reader *reader)
{
    char *folder = path_folder(suite->roots.named);
    const char *named = folder && folder[0] ? folder : ".";
    bool fits = folder && strlen(named) < sizeof settings->allowed[0];
    if (fits)
        strcpy(settings->allowed[0], named);
    free(folder);
    return fits || cli_misuse(reader, "the path of the suite's folder is too long");
}

static bool take_files(struct check_case *item, const struct suite *suite,
                       struct cli_reader *reader)
{
    struct settings *settings = item->settings;
    if (strchr(settings->scene, '/') && !allow_folder(settings, suite, reader))
        return false;
    return find_file(suite, item, "the scene ", settings->scene, sizeof settings->scene, reader) &&
           (!settings->environment[0] ||
            find_file(suite, item, "--environment ", settings->environment,
                      sizeof settings->environment, reader)) &&
           (!settings->shader[0] ||
            find_file(suite, item, "--shader ", settings->shader, sizeof settings->shader, reader));
}

/* Writes the scene and options of these settings as words. NULL: out of memory, or they are too
   long. */
static char *words_of(const struct settings *settings)
{
    char options[OPTIONS_BYTES], *text = NULL;
    size_t size, used = settings_write(settings, SETTINGS_LINE, " ", options, sizeof options);
    FILE *to = used < sizeof options ? open_memstream(&text, &size) : NULL;
    if (!to)
        return NULL;
    quote_print(settings->scene, to);
    fprintf(to, "%s%s", options[0] ? " " : "", options);
    return fclose(to) == 0 ? text : NULL;
}

static char *loading_words_of(const struct settings *settings)
{
    struct settings loaded = settings_usual();
    memcpy(loaded.scene, settings->scene, sizeof loaded.scene);
    for (const struct setting *row = settings_table; row->name; ++row) {
        if (row->need == SETTING_NEEDS_SCENE)
            setting_copy(row, settings, &loaded);
    }
    return words_of(&loaded);
}

static bool read_words(struct check_case *item, struct cli_reader *reader)
{
    char why[SETTING_WHY_BYTES];
    struct settings *settings = item->settings;
    *settings = settings_usual();
    if (!cli_read(reader, NULL, settings))
        return false;
    const char *scene = reader->positional ? reader->positional : "";
    if (!scene[0])
        return cli_misuse(reader, "a scene is missing");
    if (strlen(scene) >= sizeof settings->scene)
        return cli_misuse(reader, "the scene's path is too long");
    strcpy(settings->scene, scene);
    if (settings_given(settings, "fps") && !settings_given(settings, "frame"))
        return cli_misuse(reader, "--fps is for --frame");
    return settings_check(settings, why) || cli_misuse(reader, "%s", why);
}

/* Sets `--portable on`, so that pictures are the same on every device. */
static bool take_portable(struct check_case *item, struct cli_reader *reader)
{
    char why[SETTING_WHY_BYTES];
    return settings_read(settings_row("portable"), "on", item->settings, why) ||
           cli_misuse(reader, "--portable%s", why);
}

bool case_options_read(struct check_case *item, const struct suite *suite, const char *where,
                       int argc, char **argv, char *said, size_t said_bytes)
{
    struct cli_reader reader;
    item->settings = array_alloc_zeroed(1, sizeof *item->settings);
    cli_reader_init(&reader, &case_command, argc, argv);
    reader.where = where;
    reader.takes_files = true;
    reader.said = said;
    reader.said_bytes = said_bytes;
    if (!item->settings)
        return cli_misuse(&reader, "out of memory");
    if (!read_words(item, &reader))
        return false;
    item->made_by = words_of(item->settings);
    item->loaded = loading_words_of(item->settings);
    if (!item->made_by || !item->loaded)
        return cli_misuse(&reader, "more options than there is room for");
    return take_files(item, suite, &reader) && take_portable(item, &reader);
}

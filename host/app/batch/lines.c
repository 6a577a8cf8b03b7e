#include "app/batch/lines.h"

#include <stdlib.h>
#include <string.h>

#include "app/arguments.h"
#include "app/commands.h"
#include "app/render/render_command.h"
#include "app/render/resume.h"
#include "base/array.h"
#include "base/file.h"
#include "base/text.h"

enum { WORDS_MAX = 256, FILE_BYTES_MAX = 256 << 20 };

/* ---- A line ---- */

/* Splits a line into words behind argv[0], the command's name; a leading `whit render` is
   dropped. */
static bool split(struct cli_reader *reader, char *text, char *argv[WORDS_MAX + 1])
{
    bool whole = true;
    char *word;
    int count = 1;
    while (whole && count < WORDS_MAX && (word = cli_next_word(&text, &whole)) != NULL)
        argv[count++] = word;
    argv[count] = NULL;
    if (!whole || count == WORDS_MAX)
        return cli_misuse(reader, whole ? "too many words" : "a quote has no end");
    if (count > 2 && strcmp(argv[1], "whit") == 0 && strcmp(argv[2], "render") == 0) {
        memmove(argv + 1, argv + 3, (size_t)(count - 2) * sizeof *argv);
        count -= 2;
    }
    reader->argc = count;
    reader->argv = argv;
    return true;
}

/* Refuses options that hold for the whole process, that only make sense for a single picture, or
   that choose settings by measuring. */
static bool check(struct cli_reader *reader, const struct line *line)
{
    const struct settings *settings = &line->job.settings;
    const char *const of_process[] = {"time-limit", "device", "validation", "no-cache", "stats"};
    for (size_t i = 0; i < sizeof of_process / sizeof *of_process; ++i) {
        if (settings_given(settings, of_process[i]))
            return cli_misuse(reader, "--%s is of all lines, or of none", of_process[i]);
    }
    const char *other = render_asks(settings, &line->request, "--refine", "--max-error");
    if (!other && line->request.counters)
        other = "--counters";
    return !other || cli_misuse(reader, "%s is for `whit render`", other);
}

static void take_own(struct settings *settings, const struct settings *own)
{
    memcpy(settings->device, own->device, sizeof settings->device);
    settings->validation = own->validation;
    settings->no_cache = own->no_cache;
    settings->quiet |= own->quiet;
}

bool line_read(struct line *line, const struct lines *lines, const struct line_place *place)
{
    static char name[] = "render";
    char *argv[WORDS_MAX + 1] = {name}, said[SETTING_WHY_BYTES + SETTING_PATH_BYTES];
    struct cli_reader reader;
    snprintf(line->where, sizeof line->where, "%.1000s:%u", lines->path, place->number);
    cli_reader_init(&reader, &command_render, 1, argv);
    reader.where = line->where;
    reader.trusted = true;
    reader.said = said;
    reader.said_bytes = sizeof said;
    said[0] = '\0';
    if (place->bytes >= sizeof line->text) {
        cli_misuse(&reader, "the line is too long");
    } else {
        memcpy(line->text, lines->text + place->at, place->bytes);
        line->text[place->bytes] = '\0';
        cameras_finish(&line->request.cameras);
        line->request =
            (struct render_request){.many = true, .leaves = true, .resume = lines->resume};
        job_init(&line->job, &command_render);
        if (split(&reader, line->text, argv) &&
            render_read(&line->job, &reader, &line->request, reader.argc, argv) &&
            check(&reader, line)) {
            take_own(&line->job.settings, lines->own);
            return true;
        }
    }
    if (said[0])
        cli_error("%s", said);
    else
        cli_note("%s: this line", line->where);
    return false;
}

/* ---- All lines ---- */

static bool is_blank(const char *text, size_t bytes)
{
    size_t blank = strspn(text, " \t\r");
    return blank >= bytes || text[blank] == '#';
}

static whit_result find_places(struct lines *lines)
{
    uint32_t number = 0;
    for (size_t at = text_mark_bytes(lines->text); lines->text[at];) {
        const char *text = lines->text + at;
        struct line_place place = {.at = at, .bytes = strcspn(text, "\n"), .left = true};
        place.number = ++number;
        at += place.bytes + (text[place.bytes] == '\n');
        if (is_blank(text, place.bytes) ||
            ARRAY_PUSH(lines->places, lines->count, lines->capacity, place))
            continue;
        return cli_no_memory();
    }
    return WHIT_OK;
}

static int compare_places(const void *a, const void *b)
{
    const struct line_place *x = a, *y = b;
    if (x->scene != y->scene)
        return x->scene < y->scene ? -1 : 1;
    if (x->kernel != y->kernel)
        return x->kernel < y->kernel ? -1 : 1;
    return x->number < y->number ? -1 : 1;
}

/* Finds the first line with this hash, of those up to line `number`, so that groups sort by their
   first line in the file. False: out of memory. */
static bool find_first(struct lines *lines, uint64_t hash, uint32_t number, uint32_t *first)
{
    *first = number;
    return key_table_find(&lines->groups, &hash, sizeof hash, first) ||
           key_table_add(&lines->groups, &hash, sizeof hash, number);
}

int lines_init(struct lines *lines, struct line *line)
{
    uint8_t *text = NULL;
    size_t bytes;
    whit_result result = file_read(&cli_log, NULL, lines->path, FILE_BYTES_MAX, &text, &bytes);
    lines->text = (char *)text;
    lines->keeps = true;
    if (result == WHIT_OK && strlen(lines->text) != bytes)
        result = CLI_FAIL(WHIT_ERROR_INPUT, "%s: no lines: it has bytes that are 0", lines->path);
    if (result == WHIT_OK)
        result = find_places(lines);
    if (result == WHIT_OK && lines->count == 0)
        result = CLI_FAIL(WHIT_ERROR_INPUT, "%s: there is no line in it", lines->path);
    if (result != WHIT_OK)
        return cli_exit_of(result);
    for (uint32_t i = 0; i < lines->count; ++i) {
        struct line_place *place = &lines->places[i];
        if (!line_read(line, lines, place))
            return EXIT_USAGE;
        const struct settings *settings = &line->job.settings;
        uint32_t number = place->number;
        lines->compile |= settings_compiles(settings);
        lines->keeps &= resume_keeps(&line->request);
        if (!find_first(lines, settings_hash_scene(settings), number, &place->scene) ||
            !find_first(lines, settings_hash_kernel(settings), number, &place->kernel) ||
            !outputs_add(&lines->outputs, &line->request, number))
            return cli_exit_of(cli_no_memory());
    }
    if (!outputs_check(&lines->outputs, lines->path))
        return EXIT_USAGE;
    outputs_finish(&lines->outputs);
    if (lines->count)
        qsort(lines->places, lines->count, sizeof *lines->places, compare_places);
    return EXIT_FINE;
}

bool lines_share_scene(const struct lines *lines, const struct line_place *place)
{
    for (uint32_t i = 0; i < lines->count; ++i) {
        const struct line_place *other = &lines->places[i];
        if (other->scene == place->scene && other->kernel != place->kernel)
            return true;
    }
    return false;
}

void lines_finish(struct lines *lines)
{
    free(lines->places);
    free(lines->text);
    outputs_finish(&lines->outputs);
    key_table_finish(&lines->groups);
    *lines = (struct lines){0};
}

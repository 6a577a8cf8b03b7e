/* Many pictures and parts in one process: lines next to each other that are of one scene, trees and
   kernels share these. */
#include <stdlib.h>
#include <string.h>

#include "app/commands.h"
#include "base/file.h"
#include "whit/whit_program.h"

enum { WORDS_MAX = 256, LINE_BYTES_MAX = 64 << 10, FILE_BYTES_MAX = 256 << 20 };

struct batch_request {
    bool resume, json;
};

/* A line of the file; the words of it are in `text`. */
struct batch_line {
    char where[SETTING_PATH_BYTES + 16], text[LINE_BYTES_MAX];
    struct job job; /* settings alone */
    struct render_request request;
};

struct batch {
    const char *path;
    char *text;
    struct batch_request request;
    struct settings own;
    struct job job; /* of the line drawn last, with scene, trees and device */
    whit_renderer *renderer;
    struct frames_progress progress;
    struct batch_line line;
    whit_stats stats;                          /* of all lines */
    uint32_t lines, done, written, kept, made; /* made: scenes and renderers */
    bool *left;                                /* of each line: it is to be drawn */
    uint32_t at;                               /* the line at hand */
};

static const struct setting_value values_stats[] = {{"json", 1, NULL}, {0}};
static const struct setting options[] = {
    {"resume", 0, NULL, "`--resume` of all lines: keep files that are finished",
     SETTING_AT_FLAG(struct batch_request, resume)},
    {"stats", 0, NULL, "sums over all lines on standard output", .usual = "",
     SETTING_AT_EITHER(struct batch_request, json), .values = values_stats},
    {0},
};

/* ---- Lines ---- */

/* Words of the line, without `whit render` in front: argv[0] is the command. */
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

/* Refuses options in a line that hold for the whole process, and those that choose settings by
   measuring. */
static bool check_line(struct cli_reader *reader, const struct batch *batch)
{
    const struct batch_line *line = &batch->line;
    const struct settings *settings = &line->job.settings;
    const char *const of_process[] = {"time-limit", "device", "validation", "no-cache", "stats"};
    for (size_t i = 0; i < sizeof of_process / sizeof *of_process; ++i) {
        if (settings_given(settings, of_process[i]))
            return cli_misuse(reader, "--%s is of all lines, or of none", of_process[i]);
    }
    if (refine_is_wanted(&line->request.refine) || settings->budget_ms > 0.0 ||
        settings->max_error > 0.0)
        return cli_misuse(reader, "--refine, --budget-ms and --max-error are for `whit render`");
    return true;
}

static bool is_blank(const char *text, size_t bytes)
{
    size_t blank = strspn(text, " \t\r");
    return blank >= bytes || text[blank] == '#';
}

/* False: batch->line is not to be drawn, and why was said. */
static bool read_line(struct batch *batch, const char *text, size_t bytes, uint32_t number)
{
    static char name[] = "render";
    struct batch_line *line = &batch->line;
    char *argv[WORDS_MAX + 1] = {name}, said[SETTING_WHY_BYTES + SETTING_PATH_BYTES];
    struct cli_reader reader;
    snprintf(line->where, sizeof line->where, "%.1000s:%u", batch->path, number);
    cli_reader_init(&reader, &command_render, 1, argv);
    reader.where = line->where;
    reader.trusted = true;
    reader.said = said;
    reader.said_bytes = sizeof said;
    said[0] = '\0';
    if (bytes >= sizeof line->text) {
        cli_misuse(&reader, "the line is too long");
    } else {
        memcpy(line->text, text, bytes);
        line->text[bytes] = '\0';
        line->request =
            (struct render_request){.many = true, .leaves = true, .resume = batch->request.resume};
        job_init(&line->job, &command_render);
        if (split(&reader, line->text, argv) &&
            render_read(&line->job, &reader, &line->request, reader.argc, argv) &&
            check_line(&reader, batch))
            return true;
    }
    if (said[0])
        cli_error("%s", said);
    else
        cli_note("%s: this line", line->where);
    return false;
}

/* Calls `use` for each line that has a picture in it and is left, until one gives another code than
   EXIT_FINE. */
static int go_over(struct batch *batch, int (*use)(struct batch *batch))
{
    int status = EXIT_FINE;
    uint32_t number = 0;
    batch->at = 0;
    for (const char *at = batch->text; status == EXIT_FINE && *at;) {
        size_t bytes = strcspn(at, "\n");
        bool blank = is_blank(at, bytes);
        ++number;
        if (!blank && (!batch->left || batch->left[batch->at]))
            status = read_line(batch, at, bytes, number) ? use(batch) : EXIT_USAGE;
        batch->at += !blank;
        at += bytes + (at[bytes] == '\n');
    }
    return status;
}

static int count_line(struct batch *batch)
{
    ++batch->lines;
    return EXIT_FINE;
}

/* ---- Drawing ---- */

static void drop(struct batch *batch)
{
    whit_renderer_destroy(batch->renderer);
    batch->renderer = NULL;
    job_finish(&batch->job);
}

static whit_result prepare(struct batch *batch)
{
    struct job *job = &batch->job;
    const struct batch_line *line = &batch->line;
    if (batch->renderer && settings_same_kernel(&job->settings, &line->job.settings)) {
        job->settings = line->job.settings;
        return render_retarget(job, &line->request, batch->renderer);
    }
    drop(batch);
    *job = line->job;
    ++batch->made;
    return render_prepare(job, &line->request, &batch->progress, &batch->renderer);
}

static int draw_line(struct batch *batch)
{
    struct sequence sequence = {0};
    struct settings *settings = &batch->line.job.settings;
    int status;
    settings->quiet |= batch->own.quiet || batch->request.json;
    batch->progress.line = batch->done;
    cli_set_kept(batch->done, batch->lines, "lines were drawn");
    whit_result result = job_still_wanted();
    if (result == WHIT_OK)
        result = prepare(batch);
    if (result == WHIT_OK) {
        status = render_draw(&batch->job, &batch->line.request, batch->renderer, &batch->progress,
                             &sequence);
    } else {
        cli_progress_finish(&batch->progress.bar);
        status = cli_exit_of(result);
    }
    if (status == EXIT_FINE && !sequence.left) {
        bool frames = batch->line.request.frames.given;
        batch->left[batch->at] = false;
        ++batch->done;
        batch->kept += sequence.kept;
        batch->written += frames ? sequence.written : !sequence.kept;
        whit_stats_add(&sequence.stats, &batch->stats);
    } else if (status != EXIT_FINE && status != EXIT_INTERRUPTED && status != EXIT_TIME) {
        cli_note("%s: this line", batch->line.where);
    }
    sequence_finish(&sequence);
    return status;
}

static int print_stats(const struct batch *batch)
{
    json_t *root = document_root(), *rays = document_object(), *times = document_object();
    document_count(root, "lines", batch->lines);
    document_count(root, "written", batch->written);
    document_count(root, "kept", batch->kept);
    document_count(root, "renderers", batch->made);
    document_ms(times, "render_ms", batch->stats.render_ms);
    document_ms(times, "total_ms", whit_clock_ms() - batch->progress.bar.start_ms);
    document_put(root, "times", times);
    document_count(rays, "primary", batch->stats.rays_primary);
    document_count(rays, "shadow", batch->stats.rays_shadow);
    document_count(rays, "reflected", batch->stats.rays_reflected);
    document_count(rays, "refracted", batch->stats.rays_refracted);
    document_put(root, "rays", rays);
    return cli_print_json(root);
}

/* Lines that other processes draw come again until they are there: these may have been stopped. */
static int draw(struct batch *batch)
{
    int status = EXIT_FINE;
    batch->left = malloc(batch->lines + 1);
    if (!batch->left)
        return cli_exit_of(WHIT_ERROR_MEMORY);
    memset(batch->left, true, batch->lines + 1);
    while (status == EXIT_FINE && batch->done < batch->lines) {
        uint32_t before = batch->done;
        status = go_over(batch, draw_line);
        if (status == EXIT_FINE && batch->done == before)
            status = cli_exit_of(resume_wait());
    }
    free(batch->left);
    return status;
}

static int work(struct batch *batch)
{
    int status = go_over(batch, count_line);
    if (status != EXIT_FINE)
        return status;
    const struct job clock = {.settings = batch->own};
    job_start(&clock);
    batch->progress.lines = batch->lines;
    cli_progress_init(&batch->progress.bar, batch->own.quiet || batch->request.json);
    batch->progress.bar.start_ms = whit_clock_ms();
    status = draw(batch);
    cli_progress_finish(&batch->progress.bar);
    if (status != EXIT_FINE && !cli_cancel && !batch->own.quiet)
        cli_note("%u of %u lines were drawn", batch->done, batch->lines);
    return status == EXIT_FINE && batch->request.json ? print_stats(batch) : status;
}

static int run(const struct cli_command *command, int argc, char **argv)
{
    struct cli_reader reader;
    struct job job;
    uint8_t *text;
    size_t bytes;
    struct batch *batch = calloc(1, sizeof *batch);
    if (!batch)
        return cli_exit_of(WHIT_ERROR_MEMORY);
    job_init(&job, command);
    cli_reader_init(&reader, command, argc, argv);
    bool read = cli_read(&reader, &batch->request, &job.settings) &&
                (reader.positional || cli_misuse(&reader, "a file of lines is missing"));
    int status = reader.status;
    if (read) {
        batch->own = job.settings;
        batch->path = reader.positional;
        status = cli_exit_of(file_read(&cli_log, NULL, batch->path, FILE_BYTES_MAX, &text, &bytes));
    }
    if (read && status == EXIT_FINE) {
        batch->text = (char *)text;
        if (!batch->own.quiet)
            resume_keep_line(batch->request.resume, argc, argv);
        status = work(batch);
        free(text);
    }
    drop(batch);
    free(batch);
    return status;
}

const struct cli_command command_batch = {
    .name = "batch",
    .arguments = "PARTS.txt [options]",
    .summary = "Draws many pictures and parts in one process, a line each.",
    .details =
        "A line is what `whit render` takes: a scene and options, with or without `whit render` "
        "in\n"
        "front; # begins a remark. All lines are read before the first is drawn. Lines next to\n"
        "each other that are of one scene, trees and kernels share these.\n",
    .options = options,
    .settings = IN_BATCH,
    .run = run,
};

/* `whit batch`: draws many pictures and parts in one process, whose lines share scene, trees,
   kernels and device. */
#include <stdlib.h>

#include "app/arguments.h"
#include "app/batch/lines.h"
#include "app/commands.h"
#include "app/render/recipe.h"
#include "app/render/render_command.h"
#include "app/render/resume.h"
#include "whit/whit_program.h"

struct batch_request {
    bool resume, json;
};

/* Numbers of scenes loaded, trees built and renderers made for the lines of the command, and the
   total times of these steps. */
struct batch_made {
    uint32_t scenes, trees, renderers;
    double load_ms, build_ms, device_ms;
};

struct batch {
    struct batch_request request;
    struct lines lines;
    struct line line;
    struct job job;   /* job of the line drawn last; the next line may share its scene, trees and
                         device */
    bool scene_whole; /* the job's scene still has its texels, so another renderer can be made from
                         it */
    whit_renderer *renderer;
    struct frames_progress progress;
    struct batch_made made;
    whit_stats stats; /* of all lines */
    double start_ms, compile_ms, save_ms;
    uint32_t done, written, kept;
    uint32_t lines_kept; /* those of `done` that needed no drawing */
};

static const struct setting_value values_stats[] = {{"json", 1, NULL}, {0}};
static const struct setting options[] = {
    {"resume", 0, NULL, "`--resume` of all lines: keep files that are finished",
     SETTING_AT_FLAG(struct batch_request, resume)},
    {"stats", 0, NULL, "sums over all lines on standard output", .usual = "",
     SETTING_AT_EITHER(struct batch_request, json), .values = values_stats},
    {0},
};

/* ---- Drawing ---- */

static void drop_renderer(struct batch *batch)
{
    whit_renderer_destroy(batch->renderer);
    batch->renderer = NULL;
}

static void drop(struct batch *batch)
{
    drop_renderer(batch);
    job_finish(&batch->job);
    batch->job = (struct job){0};
}

/* Whether the compiler's process can be reused: it keeps the limits that it was started with. */
static bool same_compiler(const struct settings *a, const struct settings *b)
{
    return a->load.import_limit_s == b->load.import_limit_s &&
           a->load.memory_limit_bytes == b->load.memory_limit_bytes &&
           a->load.require_sandbox == b->load.require_sandbox;
}

/* Frees what the line cannot share with the one before. */
static void keep_shared(struct batch *batch, const struct settings *next)
{
    struct job *job = &batch->job;
    const struct settings *last = &job->settings;
    if (batch->renderer && settings_same_kernel(last, next))
        return;
    drop_renderer(batch);
    bool scene = batch->scene_whole && settings_same_scene(last, next);
    if (!scene || !settings_same_trees(last, next)) {
        whit_accel_destroy(job->accel);
        job->accel = NULL;
    }
    if (!scene) {
        whit_scene_destroy(job->scene);
        job->scene = NULL;
    }
    if (!settings_same_shader(last, next)) {
        whit_shader_destroy(job->shader);
        job->shader = NULL;
    }
    if (batch->lines.compile && !same_compiler(last, next))
        drop(batch);
}

/* `before`: the job before the line was prepared, to see what was made for this line. */
static void count_made(struct batch *batch, const struct job *before)
{
    struct batch_made *made = &batch->made;
    const struct job *job = &batch->job;
    ++made->renderers;
    made->device_ms += before->device ? 0.0 : job->device_ms;
    made->scenes += !before->scene;
    made->load_ms += before->scene ? 0.0 : job->load_ms;
    made->trees += !before->accel;
    made->build_ms += before->accel ? 0.0 : job->accel_ms;
}

static whit_result prepare(struct batch *batch, const struct line_place *place)
{
    struct job *job = &batch->job;
    struct line *line = &batch->line;
    keep_shared(batch, &line->job.settings);
    job->settings = line->job.settings;
    job->recipe_hash = line->job.recipe_hash;
    const struct job before = *job;
    bool makes = !batch->renderer;
    if (makes)
        batch->scene_whole = lines_share_scene(&batch->lines, place);
    line->request.scene_stays = batch->scene_whole;
    whit_result result = WHIT_OK;
    if (batch->lines.compile && !job->compiler)
        result = job_begin_compiler(job, &cli_log);
    if (result == WHIT_OK)
        result = render_prepare(job, &line->request, &batch->progress, &batch->renderer);
    if (result == WHIT_OK && makes)
        count_made(batch, &before);
    return result;
}

/* Starts the progress bar over all lines anew: it ends with each line, so that a message about the
   line can be printed. */
static void show_progress(struct batch *batch)
{
    struct frames_progress *progress = &batch->progress;
    cli_progress_init(&progress->bar, batch->lines.own->quiet);
    progress->bar.start_ms = batch->start_ms;
    progress->line = batch->done - batch->lines_kept; /* kept lines took no time, so the estimate
                                                         leaves them out */
    progress->lines = batch->lines.count - batch->lines_kept;
}

static int draw_line(struct batch *batch, struct line_place *place)
{
    struct sequence sequence = {0};
    const struct render_request *request = &batch->line.request;
    int status;
    show_progress(batch);
    cli_set_kept(batch->done, batch->lines.count, "lines were drawn");
    whit_result result = job_still_wanted();
    if (result == WHIT_OK)
        result = prepare(batch, place);
    if (result == WHIT_OK) {
        status = render_draw(&batch->job, request, batch->renderer, &batch->progress, &sequence);
    } else {
        cli_progress_finish(&batch->progress.bar);
        status = cli_exit_of(result);
    }
    if (status == EXIT_FINE && !sequence.left) {
        place->left = false;
        ++batch->done;
        batch->kept += sequence.kept;
        batch->lines_kept += sequence.kept && !sequence.written;
        batch->written += request->frames.given ? sequence.written : !sequence.kept;
        batch->save_ms += sequence.save_ms;
        batch->compile_ms += sequence.stats.compile_ms;
        whit_stats_add(&sequence.stats, &batch->stats);
    } else if (status != EXIT_FINE && status != EXIT_TIME && !cli_cancel) {
        cli_note("%s: this line", batch->line.where);
    }
    sequence_finish(&sequence);
    return status;
}

/* Draws all lines, then goes again over those that other processes are drawing until they are
   finished, because such a process may have been stopped. */
static int draw(struct batch *batch)
{
    int status = EXIT_FINE;
    struct lines *lines = &batch->lines;
    while (status == EXIT_FINE && batch->done < lines->count) {
        uint32_t before = batch->done;
        for (uint32_t i = 0; status == EXIT_FINE && i < lines->count; ++i) {
            if (lines->places[i].left)
                status = line_read(&batch->line, lines, &lines->places[i])
                             ? draw_line(batch, &lines->places[i])
                             : EXIT_USAGE;
        }
        if (status == EXIT_FINE && batch->done == before)
            status = cli_exit_of(resume_wait());
    }
    return status;
}

/* ---- The command ---- */

static int print_stats(const struct batch *batch)
{
    const struct batch_made *made = &batch->made;
    const whit_stats *stats = &batch->stats;
    json_t *root = document_root();
    document_count(root, "lines", batch->lines.count);
    document_count(root, "written", batch->written);
    document_count(root, "kept", batch->kept);
    document_count(root, "scenes", made->scenes);
    document_count(root, "trees", made->trees);
    document_count(root, "renderers", made->renderers);
    json_t *times = document_child(root, "times");
    document_ms(times, "device_ms", made->device_ms);
    document_ms(times, "load_ms", made->load_ms);
    document_ms(times, "build_ms", made->build_ms);
    document_ms(times, "compile_ms", batch->compile_ms);
    document_ms(times, "render_ms", stats->render_ms);
    document_ms(times, "save_ms", batch->save_ms);
    document_ms(times, "total_ms", whit_clock_ms() - batch->start_ms);
    document_put(root, "rays", recipe_rays(stats));
    return cli_print_json(root);
}

static int work(struct batch *batch, const struct settings *own)
{
    const struct job clock = {.settings = *own};
    job_start(&clock);
    int status = draw(batch);
    cli_progress_finish(&batch->progress.bar);
    if (status != EXIT_FINE && !cli_cancel && !own->quiet) {
        cli_note("%u of %u lines were drawn", batch->done, batch->lines.count);
        cli_say_next();
    }
    return status == EXIT_FINE && batch->request.json ? print_stats(batch) : status;
}

static int run(const struct cli_command *command, int argc, char **argv)
{
    struct cli_reader reader;
    struct job job;
    struct batch *batch = calloc(1, sizeof *batch);
    if (!batch)
        return cli_exit_of(WHIT_ERROR_MEMORY);
    batch->start_ms = whit_clock_ms();
    job_init(&job, command);
    cli_reader_init(&reader, command, argc, argv);
    bool read = cli_read(&reader, &batch->request, &job.settings) &&
                (reader.positional || cli_misuse(&reader, "a file of lines is missing")) &&
                cli_no_dash(&reader, "PARTS.txt", reader.positional,
                            "lines are read from a file, not from standard input");
    int status = reader.status;
    if (read) {
        bool told = !job.settings.quiet;
        job.settings.quiet |= batch->request.json;
        batch->lines = (struct lines){
            .path = reader.positional, .own = &job.settings, .resume = batch->request.resume};
        status = lines_init(&batch->lines, &batch->line);
        if (status == EXIT_FINE && told && batch->lines.keeps)
            resume_keep_line(batch->request.resume, argc, argv);
        if (status == EXIT_FINE)
            status = work(batch, &job.settings);
    }
    drop(batch);
    lines_finish(&batch->lines);
    cameras_finish(&batch->line.request.cameras);
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
        "front; a line that begins with # is a comment. All lines are read before the first is\n"
        "drawn. Lines of one scene are drawn one after the other, and share what is decoded, "
        "built\n"
        "and compiled.\n",
    .options = options,
    .settings = IN_BATCH,
    .run = run,
};

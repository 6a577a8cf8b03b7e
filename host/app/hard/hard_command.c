#include "app/arguments.h"
#include "app/commands.h"
#include "app/hard/hard_output.h"

enum { RAYS_MIN = 512, RAYS_MAX = 100000000, RAYS_QUICK = 512 };

static const struct setting_value values_hard_view[] = {{"leaks", 1, NULL}, {0}};

static const struct setting options[] = {
    {"numerics", 0, NULL, "this level alone (all three)", SETTING_AT_CHOICE(struct hard, level),
     .values = values_numerics},
    {"rays", 0, "N", "rays of each row of the table, at least 512 (20000)",
     SETTING_AT_COUNT(struct hard, params.rays), .min = RAYS_MIN, .max = RAYS_MAX},
    {"case", 0, "TEXT", "of the built-in cases those with TEXT in their name",
     SETTING_AT_NAME(struct hard, params.filter)},
    {"quick", 0, NULL, "512 rays a row", SETTING_AT_FLAG(struct hard, quick)},
    {"json", 0, "FILE", "the table as JSON", SETTING_AT_NAME(struct hard, json_path),
     .written = true},
    {"view", 0, NULL,
     "instead of the table a picture of what camera rays hit:\n"
     "red where that is wrong, yellow where another triangle is\n"
     "within the error of floats; by itself of watertight",
     SETTING_AT_CHOICE(struct hard, drawn), .values = values_hard_view},
    {"output", 'o', "FILE", "of the picture: .png .exr .pfm", SETTING_AT_NAME(struct hard, output),
     .written = true},
    {"size", 0, "WxH", "of the picture (640x480)",
     SETTING_AT_SIZE(struct hard, view.width, view.height)},
    {"camera", 0, "NAME|N|numbers", "as for `whit render`", SETTING_AT_NAME(struct hard, camera)},
    {0},
};

static whit_result prepare(struct job *job)
{
    whit_result result = WHIT_OK;
    job_begin_device(job);
    if (job->settings.scene[0])
        result = job_load(job);
    if (result == WHIT_OK && job->settings.scene[0])
        job_print_notes(job, false);
    if (result == WHIT_OK)
        result = job_open_device(job);
    if (job->device) /* a table makes a hundred renderers, which share few kernels */
        whit_device_keep_kernels(job->device);
    return result;
}

static whit_result find_out(struct hard *hard)
{
    struct job *job = &hard->job;
    whit_result result = prepare(job);
    cli_progress_init(&hard->progress, job->settings.quiet);
    hard->params.threads = job->settings.trees.threads;
    hard->params.instances = job->settings.trees.instances;
    hard->params.portable = job->settings.picture.portable;
    hard->params.cancel = &cli_cancel;
    hard->params.time_limit_s = cli_time_left_s();
    hard->params.progress = cli_progress_update;
    hard->params.progress_user = &hard->progress;
    if (result == WHIT_OK)
        result =
            whit_hard_run(job->device, job->scene, &hard->params, &cli_log_errors, &hard->report);
    cli_progress_finish(&hard->progress);
    return result;
}

static whit_result draw(struct hard *hard, uint64_t *wrong, uint64_t *other)
{
    struct job *job = &hard->job;
    whit_image *image = NULL;
    hard->view.time_s = job->settings.picture.time_s;
    hard->view.portable = job->settings.picture.portable;
    hard->view.numerics =
        hard->level == HARD_ALL ? WHIT_NUMERICS_WATERTIGHT : (whit_numerics)hard->level;
    hard->view.threads = job->settings.trees.threads;
    hard->view.instances = job->settings.trees.instances;
    whit_result result = prepare(job);
    if (result == WHIT_OK)
        result = whit_hard_view(job->device, job->scene, &hard->view, &cli_log_errors, wrong, other,
                                &image);
    if (result == WHIT_OK)
        result = job_still_wanted();
    if (result == WHIT_OK) {
        cli_set_saving();
        result = whit_image_save(image, hard->output, NULL, 0, &cli_log);
    }
    whit_image_destroy(image);
    return result;
}

static int work_view(struct hard *hard)
{
    uint64_t wrong = 0, other = 0;
    whit_result result = draw(hard, &wrong, &other);
    if (result != WHIT_OK)
        return cli_exit_of(result);
    printf(
        "%s: %s: %llu pixel%s wrong (red), %llu with another triangle within the error of floats "
        "(yellow)\n",
        cli_shown(hard->output), value_word(values_numerics, (int)hard->view.numerics),
        (unsigned long long)wrong, wrong == 1 ? "" : "s", (unsigned long long)other);
    int status = cli_finish_stdout(EXIT_FINE);
    if (status == EXIT_FINE && wrong && hard->view.numerics != WHIT_NUMERICS_FAST)
        status = EXIT_DIFFERS;
    return status == EXIT_FINE ? job_check_validation(&hard->job) : status;
}

static int work(struct hard *hard)
{
    whit_result result = find_out(hard);
    if (result == WHIT_OK && hard->json_path)
        result = hard_save_json(hard);
    if (result != WHIT_OK)
        return cli_exit_of(result);
    int status = cli_is_piped(hard->json_path) ? EXIT_FINE : hard_print(hard);
    const whit_hard_report *report = hard->report;
    if (report->unanswered)
        cli_error("%u of %u rows: the device gave no answer, so no promise of theirs is shown",
                  report->unanswered, report->row_count);
    if (status == EXIT_FINE && report->unanswered)
        status = EXIT_DIFFERS;
    if (report->broken) {
        cli_error("%u of %u rows break a promise of their level", report->broken,
                  report->row_count);
        status = status == EXIT_FINE ? EXIT_DIFFERS : status;
    }
    return status == EXIT_FINE ? job_check_validation(&hard->job) : status;
}

static bool check_view(struct cli_reader *reader, const struct hard *hard)
{
    if ((hard->drawn != 0) != (hard->output != NULL))
        return cli_misuse(reader, "--view leaks and -o FILE go together");
    bool timed =
        settings_given(&hard->job.settings, "time") || settings_given(&hard->job.settings, "frame");
    if (!hard->drawn && (hard->view.width || hard->camera || timed))
        return cli_misuse(reader, "--size, --camera, --time and --frame are of --view leaks");
    if (hard->drawn && (hard->json_path || hard->params.rays || hard->quick || hard->params.filter))
        return cli_misuse(reader, "--view leaks makes a picture, and no table");
    if (!hard->drawn)
        return true;
    if (!whit_image_format_known(hard->output, false))
        return cli_misuse(reader, "%s: pictures are .png, .exr or .pfm", hard->output);
    return cli_check_writable(reader, hard->output);
}

static bool check_request(struct cli_reader *reader, const struct hard *hard)
{
    if (!cli_check_output(reader, "--json", hard->json_path, "for a pipe give /dev/stdout") ||
        !check_view(reader, hard))
        return false;
    if (reader->positional && hard->params.filter)
        return cli_misuse(reader, "--case is of the built-in cases, not of a scene");
    return true;
}

static int run(const struct cli_command *command, int argc, char **argv)
{
    struct cli_reader reader;
    struct hard hard = {.level = HARD_ALL};
    job_init(&hard.job, command);
    cli_reader_init(&reader, command, argc, argv);
    if (!job_read(&hard.job, &reader, &hard, true) || !check_request(&reader, &hard))
        return reader.status;
    if (hard.quick)
        hard.params.rays = RAYS_QUICK;
    hard.view.camera = camera_of_text(hard.camera ? hard.camera : "");
    if (hard.level != HARD_ALL)
        hard.params.levels = 1u << hard.level;
    job_start(&hard.job);
    int status = hard.drawn ? work_view(&hard) : work(&hard);
    whit_hard_report_destroy(hard.report);
    job_finish(&hard.job);
    return status;
}

const struct cli_command command_hard = {
    .name = "hard",
    .arguments = "[SCENE] [options]",
    .summary = "Tortures the three levels of numerics, and counts what they get wrong.",
    .details =
        "Without a scene: the built-in cases. With one: rays at its edges and vertices, along\n"
        "axes, in its planes, grazing, from far away and from its surface; then its triangles\n"
        "scaled, moved, turned and mirrored, as vertices (rounded to float: another mesh) and as\n"
        "instances. Misses at outlines and beside open edges are no leaks. Columns, all against\n"
        "exact arithmetic: misses of rays that hit; leaks, those that got out of a closed surface; "
        "false hits; other\n"
        "primitives; wrong, errors beyond the bound of floats; double hits where exactly there is\n"
        "one; hits on the surface that a ray left; the largest error of t, in floats; rays whose\n"
        "hits differ by a bit between the device and its twin on the CPU. Exit code 1 when a\n"
        "promise of a level is broken: no leaks and nothing wrong (watertight), every hit exact\n"
        "(exact), equal bits (both); fast promises nothing.\n",
    .options = options,
    .settings = IN_HARD,
    .run = run,
};

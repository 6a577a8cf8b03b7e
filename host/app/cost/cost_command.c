#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/arguments.h"
#include "app/commands.h"
#include "app/cost/cost.h"
#include "app/cost/cost_json.h"
#include "app/cost/cost_table.h"
#include "base/text.h"

enum { RAYS_QUICK = 2000, RAYS_USUAL = 20000, RAYS_MAX = 1 << 22, SAMPLES_QUICK = 16 };
/* Smallest sizes in pixels; the second pair is for --quick, and has room for 16:9. */
enum { WIDTH_MIN = 320, HEIGHT_MIN = 240, WIDTH_MIN_QUICK = 160, HEIGHT_MIN_QUICK = 90 };
/* Time to stop after a signal: drivers cannot be stopped while they compile a kernel, which may
   take this long. */
enum { GRACE_MS = 20000 };

static const struct setting_value values_metric[] = {
    {"flip", COST_FLIP, NULL}, {"rmse", COST_RMSE, NULL}, {0}};
static const struct setting_value values_reference_samples[] = {
    {"4", 4, NULL}, {"16", 16, NULL}, {"64", 64, NULL}, {0}};

/* ---- Options ---- */

static bool read_knobs(const struct setting *setting, const char *list, void *record, char *why)
{
    const char *names[KNOBS];
    (void)setting;
    for (uint32_t i = 0; i < KNOBS; ++i)
        names[i] = knob_table[i].name;
    for (const char *at = list; at;) {
        char name[32];
        size_t length = strcspn(at, ",");
        snprintf(name, sizeof name, "%.*s", (int)(length < 31 ? length : 31), at);
        uint32_t found = knob_find(name);
        if (strcmp(name, "tinted-shadows") == 0)
            return setting_refuse(why, ": knob `%s` is `shadows` now", name);
        if (found == WHIT_NONE) {
            const char *nearest = text_nearest(name, names, KNOBS);
            return setting_refuse(why, ": there is no knob `%s`%s%s%s", name,
                                  nearest ? "; did you mean `" : "", nearest ? nearest : "",
                                  nearest ? "`?" : "");
        }
        ((struct cost *)record)->request.knobs |= UINT64_C(1) << found;
        at = at[length] ? at + length + 1 : NULL;
    }
    return true;
}

static const struct setting options[] = {
    {"html", 0, "FILE", "the report as one page, with a plot and pictures",
     SETTING_AT_NAME(struct cost, html), .written = true},
    {"json", 0, "FILE", "all figures as JSON", SETTING_AT_NAME(struct cost, json), .written = true},
    {"csv", 0, "FILE", "a row for each setting", SETTING_AT_NAME(struct cost, csv),
     .written = true},
    {"markdown", 0, "FILE", "the tables as Markdown", SETTING_AT_NAME(struct cost, markdown),
     .written = true},
    {"under", 0, "E",
     "find the cheapest settings with a FLIP of at most E, or by\n"
     "--metric an RMSE",
     SETTING_AT_NUMBER(struct cost, under), .min = 1e-12, .max = 1e6},
    {"within", 0, "T", "find the best picture that takes at most T ms",
     SETTING_AT_NUMBER(struct cost, within_ms), .min = 1e-3, .max = 1e9},
    {"metric", 0, NULL, "what E is, and what the best picture has least of (flip)",
     SETTING_AT_CHOICE(struct cost, metric), .values = values_metric},
    {"quick", 0, NULL, "20 s, 16 samples, 2000 rays", SETTING_AT_FLAG(struct cost, quick)},
    {"spend", 0, "S", "seconds that it may take, more or less (150)",
     SETTING_AT_NUMBER(struct cost, request.seconds), .min = 0.1, .max = 1e6},
    {"shader", 0, NULL,
     "is not of cost: errors are measured against the reference, which has no functions of yours",
     .kind = SETTING_GONE},
    {"samples", 0, NULL, "is `--reference-samples` now", .kind = SETTING_GONE},
    {"reference-samples", 0, NULL,
     "of the reference, and the most of --aa (64,\nor 16 where that keeps it large)",
     SETTING_AT_CHOICE(struct cost, request.samples_max), .values = values_reference_samples},
    {"rays", 0, "N", "of each of the two sets; 0: none (20000)",
     SETTING_AT_COUNT(struct cost, rays), .max = RAYS_MAX},
    {"knobs", 0, "NAME,...", "only these (all that the scene calls for)", .kind = SETTING_OWN,
     .read = read_knobs},
    {"compare", 0, NULL, "two files of --json in place of the scene: what differs",
     SETTING_AT_FLAG(struct cost, compares)},
    {0},
};

static bool check_files(struct cli_reader *reader, const struct cost *cost)
{
    static const char *const hint = "for a pipe give /dev/stdout";
    return cli_check_output(reader, "--html", cost->html, hint) &&
           cli_check_output(reader, "--json", cost->json, hint) &&
           cli_check_output(reader, "--csv", cost->csv, hint) &&
           cli_check_output(reader, "--markdown", cost->markdown, hint);
}

static void complete(struct cost *cost)
{
    struct cost_request *request = &cost->request;
    if (request->seconds == 0.0)
        request->seconds = cost->quick ? COST_SECONDS_QUICK : COST_SECONDS;
    if (request->samples_max == 0 && cost->quick)
        request->samples_max = SAMPLES_QUICK;
    request->judged_width_min = cost->quick ? WIDTH_MIN_QUICK : WIDTH_MIN;
    request->judged_height_min = cost->quick ? HEIGHT_MIN_QUICK : HEIGHT_MIN;
    request->rays = cost->rays != COST_RAYS_UNSAID ? cost->rays
                    : cost->quick                  ? RAYS_QUICK
                                                   : RAYS_USUAL;
    const double limits[] = {[COST_UNDER] = cost->under, [COST_WITHIN] = cost->within_ms};
    for (enum cost_goal_kind kind = COST_UNDER; kind <= COST_WITHIN; ++kind)
        if (limits[kind] > 0.0)
            request->goals[request->goal_count++] = (struct cost_goal){
                .kind = kind, .metric = (enum cost_metric)cost->metric, .limit = limits[kind]};
    if (cost->html)
        cost_strip_ask(request);
}

static const struct cost usual_cost = {.rays = COST_RAYS_UNSAID, .metric = COST_FLIP};

/* The name of an option that was given and that --compare does not read; NULL: there is none. */
static const char *find_ignored(const struct cost *cost)
{
    for (const struct setting *row = options; row->name; ++row) {
        if (strcmp(row->name, "compare") != 0 && !setting_same(row, cost, &usual_cost))
            return row->name;
    }
    for (const struct setting *row = settings_table; row->name; ++row) {
        if (strcmp(row->name, "quiet") != 0 && settings_given(&cost->job.settings, row->name))
            return row->name;
    }
    return cost->request.knobs ? "knobs" : NULL;
}

static bool check_request(struct cli_reader *reader, struct cost *cost)
{
    const char *ignored = cost->compares ? find_ignored(cost) : NULL;
    if (ignored)
        return cli_misuse(reader, "--compare prints two reports side by side, and takes no --%s",
                          ignored);
    if (cost->compares && !reader->others[0])
        return cli_misuse(reader, "--compare needs two files that --json wrote");
    if (!cost->compares && !reader->positional)
        return cli_misuse(reader, "a scene is missing");
    if (!cost->compares && reader->others[0])
        return cli_misuse(reader, "too many arguments: `%s`", reader->others[0]);
    return cost->compares || check_files(reader, cost);
}

/* ---- Work ---- */

/* Errors name what was being measured. */
static void tell(void *user, double done, double seconds_left, const char *what)
{
    struct cost *cost = user;
    snprintf(cost->doing, sizeof cost->doing, "%s", what);
    cli_errors_of(cost->doing);
    cli_progress_tell(&cost->progress, done, seconds_left, what);
}

static whit_result find_out(struct cost *cost)
{
    struct job *job = &cost->job;
    struct cost_request *request = &cost->request;
    job_begin_device(job);
    whit_result result = job_load(job);
    if (result == WHIT_OK)
        job_print_notes(job, false);
    if (result == WHIT_OK)
        result = job_build(job);
    if (result == WHIT_OK)
        result = job_open_device(job);
    if (result != WHIT_OK)
        return result;
    cli_progress_init(&cost->progress, job->settings.quiet);
    request->device = job->device;
    request->scene = job->scene;
    request->accel = job->accel;
    request->settings = &job->settings;
    request->cancel = &cli_cancel;
    request->end_ms = cli_time_end_ms();
    request->progress = tell;
    request->progress_user = cost;
    request->hush = cli_hush;
    request->log = job->settings.quiet ? &cli_log : &cli_log_notes;
    cli_keep_what_is_done(GRACE_MS);
    result = cost_measure(request, &cost->report);
    cli_errors_of(NULL);
    cli_progress_finish(&cost->progress);
    return result;
}

static void keep_first(whit_result *first, whit_result result)
{
    *first = *first == WHIT_OK ? result : *first;
}

/* Saves each file, also where another one cannot be written: what was measured took minutes. */
static whit_result save_all(const struct cost *cost)
{
    whit_result first = WHIT_OK;
    if (cost->json)
        keep_first(&first, document_save(cost_document(cost->report, cost), cost->json));
    if (cost->csv)
        keep_first(&first, document_save_written(cost->csv, cost_write_csv, cost));
    if (cost->markdown)
        keep_first(&first, document_save_written(cost->markdown, cost_write_markdown, cost));
    if (cost->html)
        keep_first(&first, cost_save_page(cost));
    return first;
}

/* EXIT_DIFFERS where a setting that must not change the picture changed it, or no settings were
   found for a goal. */
static int judge(const struct cost_report *report)
{
    int status = EXIT_FINE;
    for (uint32_t i = 0; i < report->row_count; ++i) {
        const struct cost_row *row = &report->rows[i];
        if (!row->broken)
            continue;
        cli_error("%s %s: it may change nothing, yet %llu pixels and %llu ids differ", row->knob,
                  row->setting, (unsigned long long)row->pixels_changed,
                  (unsigned long long)row->ids_changed);
        status = EXIT_DIFFERS;
    }
    for (uint32_t i = 0; i < report->answer_count; ++i) {
        const struct cost_answer *answer = &report->answers[i];
        if (answer->kept || answer->goal.of_usual > 0.0)
            continue;
        cli_error("no setting was found %s %.6g%s",
                  answer->goal.kind == COST_WITHIN ? "within" : "with an error of at most",
                  answer->goal.limit, answer->goal.kind == COST_WITHIN ? " ms" : "");
        status = EXIT_DIFFERS;
    }
    return status;
}

static void say_stopped(struct cost *cost, whit_result result)
{
    uint32_t measured = 0;
    for (uint32_t i = 0; i < cost->report->row_count; ++i)
        measured += cost->report->rows[i].measured;
    if (result == WHIT_ERROR_TIME_LIMIT)
        cli_error("the time limit passed with %u of %u settings measured", measured,
                  cost->report->row_count);
    cli_set_kept(measured, cost->report->row_count, "settings were measured");
}

static int work(struct cost *cost)
{
    whit_result result = find_out(cost);
    if (!cost->report)
        return cli_exit_of(result);
    whit_result saved = save_all(cost);
    bool piped = cli_is_piped(cost->html) || cli_is_piped(cost->json) || cli_is_piped(cost->csv) ||
                 cli_is_piped(cost->markdown);
    int status = piped ? EXIT_FINE : cost_print_text(cost);
    if (result != WHIT_OK) {
        say_stopped(cost, result);
        return cli_exit_of(result);
    }
    if (saved != WHIT_OK)
        return cli_exit_of(saved);
    if (status == EXIT_FINE)
        status = judge(cost->report);
    return status == EXIT_FINE ? job_check_validation(&cost->job) : status;
}

static int run(const struct cli_command *command, int argc, char **argv)
{
    struct cli_reader reader;
    struct cost cost = usual_cost;
    job_init(&cost.job, command);
    cli_reader_init(&reader, command, argc, argv);
    if (!job_read(&cost.job, &reader, &cost, true) || !check_request(&reader, &cost))
        return reader.status;
    if (cost.compares)
        return cost_compare_files(reader.positional, reader.others[0]);
    complete(&cost);
    job_start(&cost.job);
    cost.command = cli_line(argc, argv);
    int status = cost.command ? work(&cost) : cli_exit_of(WHIT_ERROR_MEMORY);
    cost_report_destroy(cost.report);
    free(cost.command);
    job_finish(&cost.job);
    return status;
}

static const char *knob_word(const char *option, uint32_t index)
{
    return strcmp(option, "knobs") == 0 && index < KNOBS ? knob_table[index].name : NULL;
}

const struct cli_command command_cost = {
    .name = "cost",
    .arguments = "SCENE [options]",
    .summary = "Measures what each setting costs in this scene, and what it gets wrong.",
    .details =
        "Every knob that the scene calls for, beside the usual settings of `whit render`: times "
        "in\n"
        "turns, with intervals of 95 %, and errors against the reference in double, which is kept\n"
        "in the user's cache folder. Hits are held against exact arithmetic, for rays of the\n"
        "picture and for rays aimed at the scene's edges and vertices. Exit code 1 when a setting\n"
        "that may change nothing changes a picture, or when --under or --within cannot be met.\n"
        "`whit cost --compare A B`: two files of --json. Ctrl+C and --time-limit keep what is\n"
        "measured.\n",
    .options = options,
    .settings = IN_COST,
    .others_max = 1,
    .run = run,
    .word = knob_word,
};

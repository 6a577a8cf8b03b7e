#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/commands.h"
#include "app/study.h"

enum bvh_id {
    ID_BUILD = JOB_ID_END,
    ID_THREADS,
    ID_RUNS,
    ID_RAYS,
    ID_VALIDATE,
    ID_JSON,
    ID_NO_TRACE,
};

enum { RUNS_DEFAULT = 3, RAYS_DEFAULT = 100000, RAYS_MOST = 100000000, LIST_MAX = 1024 };

static const char builders_default[] = "median,binned,sweep,spatial,binned+opt";

static const struct cli_option options[] = {
    {ID_BUILD, "build", "LIST",
     "builders, such as median,binned:7,sweep+opt,spatial:1e-6\n"
     "(median,binned,sweep,spatial,binned+opt)",
     values_build},
    {ID_THREADS, "threads", "LIST", "threads to build with, such as 1,2,4 (1 and one a core)",
     NULL},
    {ID_RUNS, "runs", "N", "builds and batches of rays that a median is of (3)", NULL},
    {ID_RAYS, "rays", "N", "rays of each kind: primary, shadow, diffuse (100000)", NULL},
    {ID_NO_TRACE, "no-trace", NULL, "trees only, no rays on a device", NULL},
    {ID_VALIDATE, "validate", NULL, "check every tree; exit code 1 when one is wrong", NULL},
    {CLI_GONE, "save", NULL, "is gone: trees are built for each run", NULL},
    {CLI_GONE, "load", NULL, "is gone: trees are built for each run", NULL},
    {ID_JSON, "json", NULL, "everything as JSON", NULL},
    JOB_OPTION_BUILDING,
    JOB_OPTION_WALKING,
    JOB_OPTION_TIME,
    JOB_OPTION_DEVICE,
    JOB_OPTION_LOADING,
    {JOB_TIME_LIMIT, "time-limit", "S", "give up after S seconds, with exit code 5", NULL},
    {JOB_VALIDATION, "validation", NULL, "run with the Vulkan validation layers", NULL},
    {'q', "quiet", NULL, "no notes, no progress, only errors", NULL},
    {0},
};

/* What the options say before they become rows. */
struct request {
    const char *builders; /* NULL: not given */
    bool has_threads;
};

static bool add_row(struct study *study, struct cli_reader *reader, struct study_row row)
{
    if (study->row_count == STUDY_ROWS_MAX)
        return cli_misuse(reader, "more than %d builders", STUDY_ROWS_MAX);
    study->rows[study->row_count++] = row;
    return true;
}

/* The end of the first item of a list: a comma before a number belongs to spatial:ALPHA,BUDGET. */
static size_t item_length(const char *list)
{
    size_t length = strcspn(list, ",");
    while (list[length] && (isdigit((unsigned char)list[length + 1]) || list[length + 1] == '.' ||
                            list[length + 1] == '-'))
        length += 1 + strcspn(list + length + 1, ",");
    return length;
}

static bool read_builders(struct study *study, struct cli_reader *reader, const char *list)
{
    for (const char *item = list;;) {
        char text[LIST_MAX];
        struct study_row row = {0};
        size_t length = item_length(item);
        snprintf(text, sizeof text, "%.*s", (int)(length < LIST_MAX ? length : LIST_MAX - 1), item);
        if (!job_read_build(reader, text, &row.build))
            return false;
        job_build_name(&row.build, row.name);
        if (!add_row(study, reader, row))
            return false;
        if (!item[length])
            return true;
        item += length + 1;
    }
}

static uint32_t core_count(void)
{
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    return cores < 1 ? 1 : cores > 64 ? 64 : (uint32_t)cores;
}

static bool read_threads(struct study *study, struct cli_reader *reader)
{
    const char *whole = reader->value;
    study->thread_count = 0;
    for (const char *item = whole;;) {
        char text[16];
        size_t length = strcspn(item, ",");
        uint32_t threads;
        snprintf(text, sizeof text, "%.*s", (int)(length < 15 ? length : 15), item);
        reader->value = text;
        bool good = cli_unsigned(reader, 0, 64, &threads);
        reader->value = whole;
        if (!good)
            return false;
        if (study->thread_count == STUDY_THREADS_MAX)
            return cli_misuse(reader, "--threads: more than %d numbers", STUDY_THREADS_MAX);
        study->threads[study->thread_count++] = threads ? threads : core_count();
        if (!item[length])
            return true;
        item += length + 1;
    }
}

static void read_option(struct cli_reader *reader, int id, struct study *study,
                        struct request *request)
{
    if (job_option(&study->job, reader, id))
        return;
    switch (id) {
    case ID_BUILD:
        request->builders = reader->value;
        study->row_count = 0;
        read_builders(study, reader, reader->value);
        break;
    case ID_THREADS:
        request->has_threads = read_threads(study, reader);
        break;
    case ID_RUNS:
        cli_unsigned(reader, 1, STUDY_RUNS_MAX, &study->run_count);
        break;
    case ID_RAYS:
        cli_unsigned(reader, 1, RAYS_MOST, &study->ray_count);
        break;
    case ID_VALIDATE:
        study->validate = true;
        break;
    case ID_JSON:
        study->json = true;
        break;
    case ID_NO_TRACE:
        study->no_trace = true;
        break;
    default:
        break;
    }
}

static void default_threads(struct study *study)
{
    study->threads[study->thread_count++] = 1;
    if (core_count() > 1)
        study->threads[study->thread_count++] = core_count();
}

static bool any_device(void)
{
    const whit_log silent = {0};
    whit_device_info *infos = NULL;
    uint32_t count = 0;
    bool usable = false;
    if (whit_device_list(&silent, &infos, &count) != WHIT_OK)
        return false;
    for (uint32_t i = 0; i < count; ++i)
        usable |= infos[i].usable;
    free(infos);
    return usable;
}

/* A device that was not asked for may be missing. */
static whit_result open_device(struct study *study)
{
    if (study->no_trace)
        return WHIT_OK;
    if (!study->job.device_name && !any_device()) {
        study->no_trace = true;
        if (!study->job.quiet)
            cli_note("there is no usable Vulkan device: no rays are traced");
        return WHIT_OK;
    }
    return job_open_device(&study->job);
}

static uint32_t count_steps(const struct study *study)
{
    uint32_t rows = study->row_count, runs = study->run_count;
    uint32_t steps = rows * study->thread_count * runs + rows;
    return study->no_trace ? steps : steps + rows + STUDY_KINDS * rows * (runs + 1);
}

static int work(struct study *study)
{
    whit_result result = job_load(&study->job);
    if (result == WHIT_OK) {
        job_print_notes(&study->job, false);
        result = open_device(study);
    }
    cli_progress_init(&study->progress, study->job.quiet);
    study->steps = count_steps(study);
    if (result == WHIT_OK)
        result = study_build(study);
    if (result == WHIT_OK)
        result = study_report(study);
    if (result == WHIT_OK && !study->no_trace)
        result = study_trace(study);
    cli_progress_finish(&study->progress);
    if (result != WHIT_OK)
        return cli_exit_of(result);
    int status = study_print(study);
    if (status == EXIT_FINE && study->differing > 0)
        status = EXIT_DIFFERS;
    return status == EXIT_FINE ? job_check_validation(&study->job) : status;
}

static int run(const struct cli_command *command, int argc, char **argv)
{
    struct cli_reader reader;
    struct request request = {0};
    struct study study = {.run_count = RUNS_DEFAULT, .ray_count = RAYS_DEFAULT};
    job_init(&study.job);
    cli_reader_init(&reader, command, argc, argv);
    for (int id; (id = cli_next(&reader)) != 0;)
        read_option(&reader, id, &study, &request);
    if (!job_options_done(&study.job, &reader))
        return reader.status;
    if (!request.builders && !read_builders(&study, &reader, builders_default))
        return reader.status;
    if (!request.has_threads)
        default_threads(&study);
    int status = work(&study);
    study_finish(&study);
    return status;
}

const struct cli_command command_bvh = {
    .name = "bvh",
    .arguments = "SCENE [options]",
    .summary = "Builds trees in several ways and compares what they cost.",
    .details =
        "Builders: binned[:K] with 2 to 256 bins, median, sweep, spatial[:ALPHA[,BUDGET]];\n"
        "+opt behind one improves its trees by reinsertion.\n"
        "SAH: expected cost of a random line by areas, in triangle tests. EPO: area of surfaces "
        "in\n"
        "boxes that they do not belong to. Pairs and tests: inner nodes opened and triangles\n"
        "tested by random lines that meet the root, counted on the CPU. Mray/s: on the device,\n"
        "rays of the first camera, from what they hit to the lights, and off it at random.\n"
        "Exit code 1: hits differ between builders, or a tree is not valid.\n",
    .options = options,
    .run = run,
};

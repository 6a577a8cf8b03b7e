#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "app/arguments.h"
#include "app/bvh/study.h"
#include "app/commands.h"
#include "base/threads.h"

enum { RUNS_DEFAULT = 3, RAYS_DEFAULT = 100000, RAYS_MAX = 100000000, LIST_MAX = 1024 };

static const char builders_default[] = "median,binned,sweep,spatial,binned+opt";

/* The end of the first item of a list: a comma before a number belongs to spatial:ALPHA,BUDGET. */
static size_t item_length(const char *list)
{
    size_t length = strcspn(list, ",");
    while (list[length] && (isdigit((unsigned char)list[length + 1]) || list[length + 1] == '.' ||
                            list[length + 1] == '-'))
        length += 1 + strcspn(list + length + 1, ",");
    return length;
}

static bool add_row(struct study *study, const char *text, char *why)
{
    whit_accel_params trees = {0};
    if (!builder_read(text, &trees, why))
        return false;
    if (trees.build == WHIT_BUILD_NONE)
        return setting_refuse(why, " `%s`: without trees there is nothing to compare", text);
    if (study->row_count == STUDY_ROWS_MAX)
        return setting_refuse(why, ": more than %d builders", STUDY_ROWS_MAX);
    struct study_row *row = &study->rows[study->row_count++];
    builder_write(&trees, row->name, sizeof row->name);
    return true;
}

static bool read_builders(const struct setting *setting, const char *list, void *record, char *why)
{
    struct study *study = record;
    (void)setting;
    study->row_count = 0;
    for (const char *item = list;;) {
        char text[LIST_MAX];
        size_t length = item_length(item);
        snprintf(text, sizeof text, "%.*s", (int)(length < LIST_MAX ? length : LIST_MAX - 1), item);
        if (!add_row(study, text, why))
            return false;
        if (!item[length])
            return true;
        item += length + 1;
    }
}

static bool read_threads(const struct setting *setting, const char *list, void *record, char *why)
{
    static const struct setting one = {.kind = SETTING_COUNT, .max = 64};
    struct study *study = record;
    (void)setting;
    study->thread_count = 0;
    for (const char *item = list;;) {
        char text[16];
        size_t length = strcspn(item, ",");
        uint32_t threads;
        snprintf(text, sizeof text, "%.*s", (int)(length < 15 ? length : 15), item);
        if (!setting_read(&one, text, &threads, why))
            return false;
        if (study->thread_count == STUDY_THREADS_MAX)
            return setting_refuse(why, ": more than %d numbers", STUDY_THREADS_MAX);
        study->threads[study->thread_count++] = threads ? threads : threads_available();
        if (!item[length])
            return true;
        item += length + 1;
    }
}

static const struct setting options[] = {
    {"build", 0, "LIST",
     "builders, such as median,binned:7,sweep+opt,spatial:1e-6\n"
     "(median,binned,sweep,spatial,binned+opt)",
     .kind = SETTING_OWN, .read = read_builders, .values = values_build},
    {"threads", 0, "LIST", "threads to build with, such as 1,2,4 (1 and one a core)",
     .kind = SETTING_OWN, .read = read_threads},
    {"runs", 0, "N", "builds and batches of rays that a median is of (3)",
     SETTING_AT_COUNT(struct study, run_count), .min = 1, .max = STUDY_RUNS_MAX},
    {"rays", 0, "N", "rays of each kind: primary, shadow, diffuse (100000)",
     SETTING_AT_COUNT(struct study, ray_count), .min = 1, .max = RAYS_MAX},
    {"no-trace", 0, NULL, "trees only, no rays on a device",
     SETTING_AT_FLAG(struct study, no_trace)},
    {"validate", 0, NULL, "check every tree; exit code 1 when one is wrong",
     SETTING_AT_FLAG(struct study, validate)},
    {"save", 0, NULL, "is gone: trees are built for each run", .kind = SETTING_GONE},
    {"load", 0, NULL, "is gone: trees are built for each run", .kind = SETTING_GONE},
    {"json", 0, NULL, "everything as JSON", SETTING_AT_FLAG(struct study, json)},
    {0},
};

static void default_threads(struct study *study)
{
    study->threads[study->thread_count++] = 1;
    if (threads_available() > 1)
        study->threads[study->thread_count++] = threads_available();
}

/* Opens the device, which may be missing unless the user named one. */
static whit_result open_device(struct study *study)
{
    if (study->no_trace)
        return WHIT_OK;
    if (!study->job.settings.device[0] && !job_any_device()) {
        study->no_trace = true;
        if (!study->job.settings.quiet)
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
    cli_progress_init(&study->progress, study->job.settings.quiet);
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
    struct study study = {.run_count = RUNS_DEFAULT, .ray_count = RAYS_DEFAULT};
    char why[SETTING_WHY_BYTES];
    job_init(&study.job, command);
    cli_reader_init(&reader, command, argc, argv);
    if (!job_read(&study.job, &reader, &study, false))
        return reader.status;
    if (!study.row_count)
        read_builders(NULL, builders_default, &study, why);
    if (!study.thread_count)
        default_threads(&study);
    job_start(&study.job);
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
        "boxes that they do not belong to. Inner and tests: inner nodes opened and triangles\n"
        "tested by random lines that meet the root, counted on the CPU. Mray/s: on the device,\n"
        "rays of the first camera, from what they hit to the lights, and off it at random.\n"
        "Exit code 1: hits differ between builders, or a tree is not valid.\n",
    .options = options,
    .settings = IN_BVH,
    .run = run,
};

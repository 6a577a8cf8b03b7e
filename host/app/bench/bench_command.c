#include <stdlib.h>
#include <string.h>

#include "app/bench/bench.h"
#include "app/cache.h"
#include "app/commands.h"
#include "base/text.h"

static const struct setting options[] = {
    {"quick", 0, NULL, "tiny pictures and few runs: shows that it works, no more",
     SETTING_AT_FLAG(struct bench, quick)},
    {"runs", 0, "N", "of each case, 1 to 99 (7; quick: 2)", SETTING_AT_COUNT(struct bench, runs),
     .min = 1, .max = SAMPLE_RUNS_MAX},
    {"json", 0, "FILE", "also write all figures as JSON", SETTING_AT_NAME(struct bench, json)},
    {"scenes", 0, "FOLDER", "where whit's scenes are (./scenes, or beside the program)",
     SETTING_AT_NAME(struct bench, scenes)},
    {"naive-limit", 0, NULL, "is gone with the builder sweep-naive", .kind = SETTING_GONE},
    {"plot", 0, "FILE.svg", "rays, frame, start: also draw how far each row is from what it must",
     SETTING_AT_NAME(struct bench, plot)},
    {"against", 0, "PROGRAM", "frame, start: another whit, timed in turns",
     SETTING_AT_NAME(struct bench, against)},
    {"keep", 0, "FOLDER", "rays: leave rays, triangles and hits there",
     SETTING_AT_NAME(struct bench, keep)},
    {0},
};

static const struct bench_kind {
    const char *name, *summary;
    whit_result (*run)(struct bench *bench);
    uint32_t width, height; /* of its pictures */
    bool has_goals;         /* rows have verdicts, which --plot draws */
    bool takes_names;       /* of models or scenes */
} benches[] = {
    {"report", "the tables of the report that whit comes from, beside its figures", bench_report,
     640, 480, false, false},
#ifdef WHIT_VIEWER
    {"view", "the viewer: pictures a second, waits, what it takes when idle; on a display",
     bench_view, 640, 480, false, false},
#endif
#ifdef WHIT_BENCH
    {"rays", "[MODEL...]: rays beside Embree's on the same ray files", bench_rays, 1280, 720, true,
     true},
    {"frame", "[SCENE...]: whole pictures beside POV-Ray, another whit, and the levels",
     bench_frame, 1280, 720, true, true},
    {"start", "the first picture, whole processes with empty caches, beside another whit",
     bench_start, 320, 240, true, false},
#endif
};
enum { BENCH_COUNT = sizeof benches / sizeof benches[0] };

static void complete(struct bench *bench, const struct bench_kind *kind)
{
    bench->width = bench->quick ? kind->width / 10 : kind->width;
    bench->height = bench->quick ? kind->height / 10 : kind->height;
    if (bench->runs == 0)
        bench->runs = bench->quick ? 2 : 7;
}

static int list_benches(void)
{
    for (uint32_t i = 0; i < BENCH_COUNT; ++i)
        printf("%-9s %s\n", benches[i].name, benches[i].summary);
    return cli_finish_stdout(EXIT_FINE);
}

/* BENCH_COUNT when there is none of that name, which was said. */
static uint32_t find_bench(struct cli_reader *reader)
{
    const char *names[BENCH_COUNT];
    for (uint32_t i = 0; i < BENCH_COUNT; ++i) {
        names[i] = benches[i].name;
        if (strcmp(benches[i].name, reader->positional) == 0)
            return i;
    }
    const char *nearest = text_nearest(reader->positional, names, BENCH_COUNT);
    if (nearest)
        cli_misuse(reader, "there is no bench `%s`; did you mean `%s`?", reader->positional,
                   nearest);
    else
        cli_misuse(reader, "there is no bench `%s`; `whit bench` lists them", reader->positional);
    return BENCH_COUNT;
}

/* Takes over the sections. */
static whit_result write_json(struct bench *bench, uint32_t index)
{
    json_t *root = document_root(), *device = document_object(), *settings = document_object();
    document_text(root, "bench", benches[index].name);
    document_text(device, "name", bench->device_info.name);
    document_text(device, "driver", bench->device_info.driver);
    document_put(root, "device", device);
    document_flag(settings, "quick", bench->quick);
    document_count(settings, "width", bench->width);
    document_count(settings, "height", bench->height);
    if (!benches[index].has_goals) {
        document_count(settings, "samples", 1);
        document_count(settings, "depth", 0);
    }
    document_count(settings, "runs", bench->runs);
    document_put(root, "settings", settings);
    document_put(root, "tables", bench->sections);
    bench->sections = NULL;
    char *text = document_line(root);
    whit_result result = WHIT_ERROR_MEMORY;
    if (text)
        result = whit_file_write(bench->json, text, strlen(text), &cli_log);
    else
        cli_error("out of memory");
    free(text);
    return result;
}

static int work(struct bench *bench, uint32_t index)
{
    const whit_device_params params = {
        .selector = bench->settings.device[0] ? bench->settings.device : NULL};
    whit_result result = whit_device_create(&params, &cli_log, &bench->device);
    bench->sections = document_array();
    if (result == WHIT_OK) {
        whit_device_get_info(bench->device, &bench->device_info);
        result = benches[index].run(bench);
    }
    if (result == WHIT_OK && bench->json)
        result = write_json(bench, index);
    json_decref(bench->sections);
    whit_device_destroy(bench->device);
    return result == WHIT_OK ? cli_finish_stdout(EXIT_FINE) : cli_exit_of(result);
}

/* Misuse, and false, where the bench does not take what is given. */
static bool check_request(struct cli_reader *reader, struct bench *bench, uint32_t index)
{
    const struct bench_kind *kind = &benches[index];
    bool is_rays = strcmp(kind->name, "rays") == 0;
    bench->names = reader->others;
    bench->name_count = reader->other_count;
    if (!kind->takes_names && bench->name_count)
        return cli_misuse(reader, "`%s` is one argument too many", bench->names[0]);
    if (bench->plot && !kind->has_goals)
        return cli_misuse(reader, "--plot: `whit bench %s` draws none", kind->name);
    if (bench->against && (is_rays || !kind->has_goals))
        return cli_misuse(reader, "--against is an option of `whit bench frame` and `start`");
    if (bench->keep && !is_rays)
        return cli_misuse(reader, "--keep is an option of `whit bench rays`");
    if (!cli_no_dash(reader, "--json", bench->json, "figures go to a file; tables are printed") ||
        !cli_no_dash(reader, "--plot", bench->plot, "the drawing goes to a file"))
        return false;
    reader->status = EXIT_USAGE;
    return (!bench->json || cli_can_write(bench->json)) &&
           (!bench->plot || cli_can_write(bench->plot));
}

static int run(const struct cli_command *command, int argc, char **argv)
{
    struct cli_reader reader;
    struct bench bench = {.settings = settings_usual()};
    cli_reader_init(&reader, command, argc, argv);
    if (!cli_read(&reader, &bench, &bench.settings))
        return reader.status;
    if (!reader.positional)
        return list_benches();
    uint32_t index = find_bench(&reader);
    if (index == BENCH_COUNT || !check_request(&reader, &bench, index))
        return reader.status;
    complete(&bench, &benches[index]);
    cache_prepare(bench.settings.no_cache);
    return work(&bench, index);
}

const struct cli_command command_bench = {
    .name = "bench",
    .arguments = "[BENCH] [MODEL or SCENE...] [options]",
    .takes_many = true,
    .summary = "Measures what choices cost on this machine, and prints the tables.",
    .details = "Without BENCH it lists the benches. Tables are Markdown, on standard output.\n",
    .options = options,
    .settings = IN_BENCH,
    .run = run,
};

#include <stdlib.h>
#include <string.h>

#include "app/bench.h"
#include "app/cache.h"
#include "app/commands.h"

enum bench_id { ID_QUICK = 256, ID_RUNS, ID_JSON, ID_SCENES, ID_NAIVE, ID_DEVICE, ID_NO_CACHE };

static const struct cli_option options[] = {
    {ID_QUICK, "quick", NULL, "tiny pictures and few runs: shows that it works, no more"},
    {ID_RUNS, "runs", "N", "of each case, 1 to 99 (7; quick: 2)"},
    {ID_JSON, "json", "FILE", "also write all figures as JSON"},
    {ID_SCENES, "scenes", "FOLDER", "where whit's scenes are (./scenes, or beside the program)"},
    {ID_NAIVE, "naive-limit", "S",
     "seconds for sweep-naive, which is estimated beyond (60;\n"
     "quick: 0.2)"},
    {ID_DEVICE, "device", "auto|N|NAME", "Vulkan device; see `whit devices` (auto)"},
    {ID_NO_CACHE, "no-cache", NULL, JOB_NO_CACHE_HELP},
    {'q', "quiet", NULL, "no progress"},
    {0, NULL, NULL, NULL},
};

static const struct {
    const char *name, *summary;
    whit_result (*run)(struct bench *bench);
} benches[] = {
    {"report", "the tables of the report that whit comes from, beside its figures", bench_report},
#ifdef WHIT_VIEWER
    {"view", "the viewer: pictures a second, waits, what it takes when idle; on a display",
     bench_view},
#endif
};
enum { BENCH_COUNT = sizeof benches / sizeof benches[0] };

static void read_option(struct cli_reader *reader, int id, struct bench *bench)
{
    switch (id) {
    case ID_QUICK:
        bench->quick = true;
        break;
    case ID_RUNS:
        cli_unsigned(reader, 1, BENCH_RUNS_MOST, &bench->runs);
        break;
    case ID_JSON:
        bench->json = reader->value;
        break;
    case ID_SCENES:
        bench->scenes = reader->value;
        break;
    case ID_NAIVE:
        cli_number(reader, 1e-3, 1e6, &bench->naive_limit_s);
        break;
    case ID_DEVICE:
        bench->device_name = reader->value;
        break;
    case ID_NO_CACHE:
        bench->no_cache = true;
        break;
    case 'q':
        bench->quiet = true;
        break;
    default:
        break;
    }
}

static void complete(struct bench *bench)
{
    bench->width = bench->quick ? 64 : 640;
    bench->height = bench->quick ? 48 : 480;
    if (bench->runs == 0)
        bench->runs = bench->quick ? 2 : 7;
    if (bench->naive_limit_s == 0.0)
        bench->naive_limit_s = bench->quick ? 0.2 : 60.0;
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
    const char *nearest = cli_nearest(reader->positional, names, BENCH_COUNT);
    if (nearest)
        cli_misuse(reader, "there is no bench `%s`; did you mean `%s`?", reader->positional,
                   nearest);
    else
        cli_misuse(reader, "there is no bench `%s`; `whit bench` lists them", reader->positional);
    return BENCH_COUNT;
}

/* Takes over the sections. */
static whit_result write_json(struct bench *bench, const char *name)
{
    json_t *root = document_object(), *device = document_object(), *settings = document_object();
    document_text(root, "whit", WHIT_VERSION);
    document_text(root, "bench", name);
    document_text(device, "name", bench->device_info.name);
    document_text(device, "driver", bench->device_info.driver);
    document_put(root, "device", device);
    document_flag(settings, "quick", bench->quick);
    document_count(settings, "width", bench->width);
    document_count(settings, "height", bench->height);
    document_count(settings, "samples", 1);
    document_count(settings, "depth", 0);
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
    const whit_device_params params = {.selector = bench->device_name};
    whit_result result = whit_device_create(&params, &cli_log, &bench->device);
    bench->sections = document_array();
    if (result == WHIT_OK) {
        whit_device_get_info(bench->device, &bench->device_info);
        result = benches[index].run(bench);
    }
    if (result == WHIT_OK && bench->json)
        result = write_json(bench, benches[index].name);
    json_decref(bench->sections);
    whit_device_destroy(bench->device);
    return result == WHIT_OK ? cli_finish_stdout(EXIT_FINE) : cli_exit_of(result);
}

static int run(const struct cli_command *command, int argc, char **argv)
{
    struct cli_reader reader;
    struct bench bench = {0};
    cli_reader_init(&reader, command, argc, argv);
    for (int id; (id = cli_next(&reader)) != 0;)
        read_option(&reader, id, &bench);
    if (reader.status >= 0)
        return reader.status;
    if (!reader.positional)
        return list_benches();
    uint32_t index = find_bench(&reader);
    if (index == BENCH_COUNT ||
        !cli_no_dash(&reader, "--json", bench.json, "figures go to a file; tables are printed"))
        return reader.status;
    if (bench.json && !cli_can_write(bench.json))
        return EXIT_USAGE;
    complete(&bench);
    cache_prepare(bench.no_cache);
    return work(&bench, index);
}

const struct cli_command command_bench = {
    .name = "bench",
    .arguments = "[BENCH] [options]",
    .summary = "Measures what choices cost on this machine, and prints the tables.",
    .details = "Without BENCH it lists the benches. Tables are Markdown, on standard output.\n",
    .options = options,
    .run = run,
};

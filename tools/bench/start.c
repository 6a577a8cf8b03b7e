/* `whit bench start`: measures the time to the first picture of whole processes with empty caches,
   beside another version of whit; also on the lavapipe that tools/second-driver unpacks. */
#include <stdlib.h>
#include <string.h>

#include "bench/frame_peers.h"
#include "bench/process.h"

enum { SIDES = 2 };

/* Goals are ratios to the time of the other whit; they were set for a comparison with version
   77b2e52. */
static const struct start {
    const char *label, *scene, *size; /* size: NULL: a probe of the middle of 640x480 */
    bool warm, second;                /* warm: caches are filled; second: on the second driver */
    struct goal clock, cpu;
} starts[] = {
    {"34k, 320x240", "34k", "320x240", false, false, {1.0, 0.6, false}, {1.3, 1.0, false}},
    {"default, 320x240", "default", "320x240", false, false, {0.75, 0.6, false}, {1.3, 1.0, false}},
    {"whitted, 320x240", "whitted", "320x240", false, false, {0.75, 0.6, false}, {1.3, 1.0, false}},
    {"cube, 1280x720, filled", "cube", "1280x720", true, false, {0.64, 0.5, false}, {0, 0, false}},
    {"whitted, second driver",
     "whitted",
     "320x240",
     false,
     true,
     {0, 0, false},
     {0.61, 0.45, false}},
    {"probe default, second", "default", NULL, false, true, {0, 0, false}, {0.26, 0.16, false}},
};
enum { STARTS = sizeof starts / sizeof starts[0] };

struct starting {
    struct bench *bench;
    struct table *table;
    struct peers peers;
    const struct start *start;
    char scene[BENCH_PATH], second[BENCH_PATH];
    struct sample_runs clock[SIDES], cpu[SIDES]; /* of this whit; of the other one */
};

/* Runs one side. Round 0 fills file and whit's caches; where caches are to be empty, they are
   removed before each run. */
static whit_result run_side(void *user, uint32_t side, uint32_t round)
{
    struct starting *s = user;
    const struct start *start = s->start;
    char cache[BENCH_PATH], home[BENCH_PATH + 64], drivers[2][BENCH_PATH + 32];
    struct process_times times;
    struct process process = {
        .program = "env", .folder = s->bench->folder, .out = "start.out", .err = "start.err"};
    bench_file(s->bench, side ? "cache1" : "cache0", cache);
    snprintf(home, sizeof home, "XDG_CACHE_HOME=%s", cache);
    snprintf(drivers[0], sizeof drivers[0], "VK_DRIVER_FILES=%s", s->second);
    snprintf(drivers[1], sizeof drivers[1], "VK_ICD_FILENAMES=%s", s->second);
    process_add(&process, "env", "-u", "MESA_SHADER_CACHE_DIR", "-u", "MESA_SHADER_CACHE_MAX_SIZE",
                home, NULL);
    if (start->second)
        process_add(&process, drivers[0], drivers[1], NULL);
    process_add(&process, side ? s->peers.against : s->bench->whit, NULL);
    if (start->size)
        process_add(&process, "render", s->scene, "-o", "start.png", "--size",
                    s->bench->ask.quick ? "32x24" : start->size, NULL);
    else
        process_add(&process, "probe", s->scene, "--pixel", "320,240", NULL);
    process_add(&process, "--quiet", NULL);
    if (!start->second)
        process_add_device(&process, s->bench);
    if (!start->warm)
        process_remove_folder(cache);
    whit_result result = process_run(&process, &times);
    if (result == WHIT_OK && round > 0) {
        sample_add(&s->clock[side], times.clock_ms);
        sample_add(&s->cpu[side], times.cpu_ms);
    }
    return result;
}

static void put_row(const struct starting *s, const char *what, const struct sample_runs *of,
                    struct goal goal)
{
    struct figure figure = table_ratio(&of[0], &of[1], goal);
    json_t *row = document_object();
    snprintf(figure.name, sizeof figure.name, "%s, %s", s->start->label, what);
    document_text(row, "start", s->start->label);
    document_text(row, "time", what);
    document_put(row, "ms", table_times(&of[0]));
    if (of[1].count)
        document_put(row, "beside_ms", table_times(&of[1]));
    table_row(s->table);
    table_cell(s->table, "%s", s->start->label);
    table_cell(s->table, "%s", what);
    table_ms(s->table, &of[0]);
    table_ms(s->table, &of[1]);
    table_figure(s->table, &figure, row);
}

static whit_result run_start(struct starting *s, const struct start *start)
{
    s->start = start;
    memset(s->clock, 0, sizeof s->clock);
    memset(s->cpu, 0, sizeof s->cpu);
    if (start->second && !s->second[0])
        return WHIT_OK; /* the table says once that it is missing */
    whit_result result = bench_find(s->bench, start->scene, s->scene);
    if (result == WHIT_OK)
        result = sample_in_turns(s->peers.against[0] ? 2 : 1, s->bench->ask.runs + 1, run_side, s);
    if (result == WHIT_OK && start->clock.must > 0.0)
        put_row(s, "clock", s->clock, start->clock);
    if (result == WHIT_OK && start->cpu.must > 0.0)
        put_row(s, "processor", s->cpu, start->cpu);
    return result == WHIT_OK ? bench_step(s->bench) : result;
}

whit_result bench_start(struct bench *bench)
{
    static const char *const heads[] = {"first picture", "time", "whit, ms", "beside, ms", NULL};
    struct table table;
    struct starting s = {.bench = bench, .table = &table};
    table_begin(&table, bench, "start", heads, true, STARTS);
    table_say(&table, "Whole processes with empty caches but where they are filled. Figure: times "
                      "the time of the other whit.");
    if (!bench_find_beside(bench, "../build/second-driver/lvp_icd.json", s.second))
        table_leave_out(&table, "the second driver", "./tools/second-driver has not unpacked it");
    whit_result result = peers_find_against(&s.peers, &table);
    for (size_t i = 0; result == WHIT_OK && i < STARTS; ++i)
        result = run_start(&s, &starts[i]);
    return table_end(&table, "First pictures", result);
}

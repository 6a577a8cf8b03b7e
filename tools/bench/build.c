/* `whit bench build`: builds a single tree over all triangles of a model by whit's builders and by
   Embree, and measures frames with whit's trees. The linker redirects whit's allocations to this
   file (tools/CMakeLists.txt), which counts them while trees are built. */
#include <malloc.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/path.h"
#include "bench/cases.h"
#include "bench/peer.h"
#include "bench/table.h"

/* ---- Memory ---- */

static _Atomic bool is_counting;
static _Atomic int64_t bytes_now, bytes_peak;

static void *counted(void *memory, int64_t sign)
{
    if (!is_counting)
        return memory;
    int64_t bytes = sign * (int64_t)malloc_usable_size(memory);
    int64_t now = atomic_fetch_add(&bytes_now, bytes) + bytes, peak = bytes_peak;
    while (now > peak && !atomic_compare_exchange_weak(&bytes_peak, &peak, now))
        ;
    return memory;
}

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *memory, size_t size);
void *__real_aligned_alloc(size_t alignment, size_t size);
void __real_free(void *memory);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *memory, size_t size);
void *__wrap_aligned_alloc(size_t alignment, size_t size);
void __wrap_free(void *memory);

void *__wrap_malloc(size_t size)
{
    return counted(__real_malloc(size), 1);
}
void *__wrap_calloc(size_t count, size_t size)
{
    return counted(__real_calloc(count, size), 1);
}
void *__wrap_realloc(void *memory, size_t size)
{
    return counted(__real_realloc(counted(memory, -1), size), 1);
}
void *__wrap_aligned_alloc(size_t alignment, size_t size)
{
    return counted(__real_aligned_alloc(alignment, size), 1);
}
void __wrap_free(void *memory)
{
    __real_free(counted(memory, -1));
}

/* ---- Builds ---- */

/* Above this number of triangles there is no memory for all trees at once, so pictures are not
   drawn in turns. */
enum { LARGE = 200000 };

static const struct builder {
    const char *name;
    whit_accel_params params;
    const char *quality; /* Embree's build quality; NULL: one of whit's builders */
    bool in_quick;
} builders[] = {
    {.name = "median", .params.build = WHIT_BUILD_MEDIAN},
    {.name = "binned"},
    {.name = "binned:2", .params.bins = 2},
    {.name = "binned:4", .params.bins = 4},
    {.name = "binned:7", .params.bins = 7, .in_quick = true},
    {.name = "binned:8", .params.bins = 8},
    {.name = "binned:16", .params.bins = 16},
    {.name = "binned:32", .params.bins = 32},
    {.name = "binned:64", .params.bins = 64},
    {.name = "sweep", .params.build = WHIT_BUILD_SWEEP, .in_quick = true},
    {.name = "spatial", .params.build = WHIT_BUILD_SPATIAL, .in_quick = true},
    {.name = "binned+opt", .params.optimize = true},
    {.name = "binned:16+opt", .params = {.bins = 16, .optimize = true}},
    {.name = "sweep+opt", .params = {.build = WHIT_BUILD_SWEEP, .optimize = true}},
    {.name = "spatial+opt", .params = {.build = WHIT_BUILD_SPATIAL, .optimize = true}},
    {.name = "Embree MEDIUM", .quality = "medium", .in_quick = true},
    {.name = "Embree HIGH", .quality = "high"},
};
enum { BUILDERS = sizeof builders / sizeof builders[0] };

struct building {
    struct bench *bench;
    struct peer peer;
    struct bench_case cases[BUILDERS]; /* whit's builders, then Embree's; their `build` times are
                                          with one thread per core */
    struct builder builders[BUILDERS];
    struct sample_runs alone[BUILDERS]; /* times in ms with one thread */
    double bytes[BUILDERS];             /* peak memory of a build, with its result */
    uint32_t count, own_count, cores, threads;
    bool is_alone;
};

static whit_result build_here(struct building *b, uint32_t index, double *ms)
{
    struct bench_case *c = &b->cases[index];
    c->accel_params.threads = b->threads;
    whit_accel_destroy(c->accel); /* the old tree is freed before counting starts */
    c->accel = NULL;
    bytes_now = bytes_peak = 0;
    is_counting = true;
    whit_result result = case_build(c);
    is_counting = false;
    b->bytes[index] = (double)bytes_peak;
    *ms = c->accel_info.build_ms;
    if (c->loaded.info.triangle_count > LARGE) {
        whit_accel_destroy(c->accel);
        c->accel = NULL;
    }
    return result;
}

/* Round 0 is a warm-up. */
static whit_result build_once(void *user, uint32_t index, uint32_t round)
{
    struct building *b = user;
    const char *quality = b->builders[index].quality;
    double ms = 0.0;
    whit_result result = quality ? peer_build(&b->peer, quality, b->threads, &ms, &b->bytes[index])
                                 : build_here(b, index, &ms);
    if (result != WHIT_OK)
        return result;
    if (round > 0)
        sample_add(b->is_alone ? &b->alone[index] : &b->cases[index].build, ms);
    return bench_step(b->bench);
}

/* ---- Rows ---- */

static void put_row(struct table *table, const struct building *b, uint32_t index)
{
    const struct bench_case *c = &b->cases[index];
    double bytes = b->bytes[index] / (double)c->loaded.info.triangle_count;
    json_t *row = case_document(c);
    document_put(row, "one_thread_ms", table_times(&b->alone[index]));
    document_number(row, "bytes_per_triangle", bytes);
    table_keep(table, row);
    table_row(table);
    table_cell(table, "%s", c->label);
    table_ms(table, &b->alone[index]);
    table_ms(table, &c->build);
    table_cell(table, "%.0f", bytes);
    if (c->accel_info.node_count) {
        table_cell(table, "%u", c->accel_info.reference_count);
        table_cell(table, "%.2f", c->accel_info.sah_cost);
    }
    if (c->frame.count) {
        table_cell(table, "%.2f", case_visits(c));
        table_cell(table, "%.2f", case_triangle_tests(c));
        table_ms(table, &c->frame);
    }
}

/* ---- Models ---- */

/* A quick run keeps a few of the builders. */
static void choose(struct building *b, const char *name, const struct bench_scene *loaded)
{
    bool quick = b->bench->ask.quick, has_embree = !peer_why_not(PEER_EMBREE, &loaded->info);
    for (uint32_t i = 0; i < BUILDERS; ++i) {
        const struct builder *builder = &builders[i];
        if ((quick && !builder->in_quick) || (builder->quality && !has_embree))
            continue;
        b->builders[b->count] = *builder;
        b->cases[b->count] = (struct bench_case){.label = builder->name,
                                                 .scene = name,
                                                 .loaded = *loaded,
                                                 .accel_params = builder->params};
        b->cases[b->count++].accel_params.instances = WHIT_INSTANCES_OFF;
        b->own_count += !builder->quality;
    }
}

static whit_result measure(struct building *b, struct table *table)
{
    const struct bench_scene *loaded = &b->cases[0].loaded;
    whit_result result = WHIT_OK;
    table_say(table,
              "One tree over all triangles; peak: the most memory that its build held at one "
              "time, bytes a triangle. Frames are drawn of up to %d triangles.",
              LARGE);
    if (b->count == b->own_count) {
        table_leave_out(table, "Embree", peer_why_not(PEER_EMBREE, &loaded->info));
    } else {
        result = peer_begin(&b->peer, PEER_EMBREE, b->bench, loaded->scene, "triangles");
        table_say(table, "Beside Embree %s.", b->peer.version);
    }
    for (int i = 0; result == WHIT_OK && i < 2; ++i) {
        b->is_alone = i == 0;
        b->threads = b->is_alone ? 1 : b->cores;
        result = sample_in_turns(b->count, b->bench->ask.runs + 1, build_once, b);
    }
    if (result == WHIT_OK && loaded->info.triangle_count <= LARGE)
        result = cases_draw(b->bench, b->cases, b->own_count);
    for (uint32_t i = 0; result == WHIT_OK && i < b->count; ++i)
        put_row(table, b, i);
    return result;
}

static whit_result build_model(struct bench *bench, const char *path)
{
    char all[24], title[120];
    const char *const heads[] = {
        "build",    "1 thread, ms", all,           "peak, bytes", "references",
        "SAH cost", "visits a ray", "tests a ray", "ms a frame",  NULL};
    struct table table;
    struct bench_scene loaded = {0};
    struct building *b = calloc(1, sizeof *b);
    whit_result result = b ? bench_load(path, &loaded) : WHIT_ERROR_MEMORY;
    if (result == WHIT_OK && loaded.info.triangle_count == 0) {
        cli_error("%s: has no triangles, of which trees could be made", path);
        bench_unload(&loaded);
        result = WHIT_ERROR_INPUT;
    }
    if (result != WHIT_OK) {
        free(b);
        return result;
    }
    b->bench = bench;
    b->cores = (uint32_t)sysconf(_SC_NPROCESSORS_ONLN);
    choose(b, path_name(path), &loaded);
    snprintf(all, sizeof all, "%u threads, ms", b->cores);
    snprintf(title, sizeof title, "%.60s: %llu triangles", cli_shown(path_name(path)),
             (unsigned long long)loaded.info.triangle_count);
    table_begin(&table, bench, "build", heads, false,
                2 * b->count * (bench->ask.runs + 1) + b->own_count * cases_steps(bench));
    document_text(table.object, "model", path_name(path));
    result = measure(b, &table);
    peer_end(&b->peer);
    cases_finish(b->cases, b->count);
    free(b);
    return table_end(&table, title, result);
}

whit_result bench_build(struct bench *bench)
{
    static const char *const usual[] = {"54k", "strands", "atrium"};
    char path[BENCH_PATH];
    uint32_t count = bench->ask.name_count ? bench->ask.name_count : 3;
    whit_result result = WHIT_OK;
    for (uint32_t i = 0; result == WHIT_OK && i < count; ++i) {
        if (bench->ask.name_count)
            snprintf(path, sizeof path, "%s", bench->ask.names[i]);
        else
            result = bench_find(bench, usual[i], path);
        if (result == WHIT_OK)
            result = build_model(bench, path);
    }
    return result;
}

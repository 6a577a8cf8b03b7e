/* `whit bench look`: how soon the window shows a model that whit has never drawn. Each run has the
   caches that other scenes have filled, in a copy of its own. A scene file is also drawn with as
   many samples as it is refined to at rest. */
#include <stdlib.h>

#include "base/path.h"
#include "bench/process.h"
#include "bench/table.h"
#include "whit/whit_program.h"

/* Scenes that fill the caches. */
static const char *const others[] = {"cube", "34k", "54k", "default", "whitted", "room", "balls"};
enum { OTHERS = sizeof others / sizeof *others };
/* Seconds; there are no further aims. A picture that can be recognised has at least PICTURE_WIDTH
   pixels across. */
static const struct goal first_goal = {0.4, 0.4, false}, textured_goal = {0.7, 0.7, false},
                         whole_goal = {1.2, 1.2, false}, scene_goal = {1.6, 1.6, false},
                         refined_goal = {22.0, 22.0, false};
enum { PICTURE_WIDTH = 160 };
static const char replay[] = "clock real\npicture\nstate first\nstill\nstate whole\n";

struct look {
    struct bench *bench;
    struct table *table;
    char filled[BENCH_PATH], cache[BENCH_PATH], replay[BENCH_PATH], states[BENCH_PATH];
    struct sample_runs first, whole, refined; /* ms from the start of the process */
    double narrowest;                         /* width of a first picture, pixels */
};

static double number_at(const struct look *look, const char *state, const char *part,
                        const char *key)
{
    json_t *object = states_find(look->states, state, part);
    double value = json_number_value(json_object_get(object, key));
    json_decref(object);
    return value;
}

static whit_result run_viewer(const struct look *look, const char *path, const char *cache,
                              const char *samples)
{
    const struct bench_request *ask = &look->bench->ask;
    char messages[BENCH_PATH], size[32];
    struct process process = {.program = look->bench->whit, .out = look->states, .err = messages};
    bench_file(look->bench, "messages", messages);
    snprintf(size, sizeof size, "%ux%u", ask->width, ask->height);
    process_add(&process, "whit", "view", path, "--size", size, "--aa", samples, "--quiet",
                "--replay", look->replay, "--remember", "no", NULL);
    process_add_device(&process, look->bench);
    if (setenv("XDG_CACHE_HOME", cache, 1) != 0)
        return WHIT_ERROR_MEMORY;
    return process_run(&process, NULL);
}

static whit_result fill_caches(const struct look *look)
{
    char path[BENCH_PATH];
    whit_result result = WHIT_OK;
    for (int i = 0; result == WHIT_OK && i < (look->bench->ask.quick ? 1 : OTHERS); ++i) {
        result = bench_find(look->bench, others[i], path);
        if (result == WHIT_OK)
            result = run_viewer(look, path, look->filled, "1");
        if (result == WHIT_OK)
            result = bench_step(look->bench);
    }
    return result;
}

/* Shows the scene with this many samples, with a copy of the filled caches. */
static whit_result show(const struct look *look, const char *path, const char *samples,
                        double *start_ms)
{
    struct process copy = {.program = "cp"};
    process_add(&copy, "cp", "-R", look->filled, look->cache, NULL);
    whit_result result = process_run(&copy, NULL);
    *start_ms = whit_clock_ms();
    if (result == WHIT_OK)
        result = run_viewer(look, path, look->cache, samples);
    process_remove_folder(look->cache);
    return result;
}

static whit_result run_once(struct look *look, const char *path)
{
    double start_ms;
    whit_result result = WHIT_OK;
    if (path_is(path, "json")) {
        result = show(look, path, "16", &start_ms);
        if (result == WHIT_OK)
            sample_add(&look->refined, number_at(look, "whole", "measure", "clock_ms") - start_ms);
    }
    if (result == WHIT_OK)
        result = show(look, path, "1", &start_ms);
    if (result != WHIT_OK)
        return result;
    double first_ms = number_at(look, "first", "measure", "first_ms") - start_ms;
    double width = number_at(look, "first", "frame", "width");
    if (first_ms <= 0.0 || width <= 0.0)
        return CLI_FAIL(WHIT_ERROR_FAILED, "`whit view` did not tell its figures");
    sample_add(&look->first, first_ms);
    sample_add(&look->whole, number_at(look, "whole", "measure", "clock_ms") - start_ms);
    look->narrowest = look->narrowest > 0.0 && look->narrowest < width ? look->narrowest : width;
    return bench_step(look->bench);
}

static void put_row(const struct look *look, const char *path, const char *what,
                    const struct sample_runs *runs, struct goal goal)
{
    const struct sample_summary ms = sample_of(runs);
    struct figure figure = {
        .unit = "s", .value = ms.median * 1e-3, .spread = ms.spread * 1e-3, .goal = goal};
    json_t *row = document_object();
    snprintf(figure.name, sizeof figure.name, "%s, %s", path_name(path), what);
    document_text(row, "model", path);
    document_text(row, "picture", what);
    document_put(row, "ms", table_times(runs));
    document_number(row, "narrowest", look->narrowest);
    table_row(look->table);
    table_cell(look->table, "%s", path_name(path));
    table_cell(look->table, "%s", what);
    table_figure(look->table, &figure, row);
}

static whit_result run_model(struct look *look, const char *path)
{
    struct bench_scene loaded = {0};
    whit_result result = bench_load(path, &loaded);
    bool has_textures = result == WHIT_OK && loaded.info.texture_count > 0;
    if (result == WHIT_OK)
        bench_unload(&loaded);
    bool is_scene = path_is(path, "json");
    look->first.count = look->whole.count = look->refined.count = 0;
    look->narrowest = 0.0;
    for (uint32_t i = 0; result == WHIT_OK && i < look->bench->ask.runs; ++i)
        result = run_once(look, path);
    if (result != WHIT_OK)
        return result;
    put_row(look, path, "first", &look->first, has_textures ? textured_goal : first_goal);
    put_row(look, path, "whole", &look->whole, is_scene ? scene_goal : whole_goal);
    if (is_scene)
        put_row(look, path, "16 samples", &look->refined, refined_goal);
    if (look->narrowest < PICTURE_WIDTH && !look->bench->ask.quick)
        table_say(look->table, "%s: its first picture has %.0f pixels across, fewer than %d.",
                  path_name(path), look->narrowest, PICTURE_WIDTH);
    return WHIT_OK;
}

whit_result bench_look(struct bench *bench)
{
    static const char *const heads[] = {"model", "picture", NULL};
    const struct bench_request *ask = &bench->ask;
    struct table table;
    struct look look = {.bench = bench, .table = &table};
    if (ask->name_count == 0)
        return CLI_FAIL(WHIT_ERROR_USAGE,
                        "`whit bench look` takes the files of models that whit has not drawn yet");
    whit_result result = bench_look_for(bench);
    if (result != WHIT_OK)
        return result;
    table_begin(&table, bench, "look", heads, true, OTHERS + ask->name_count * ask->runs);
    table_say(&table,
              "Times by the clock from the start of `whit view` until the window shows the first "
              "picture, and the whole one, of %u x %u pixels. Caches are filled by whit's scenes "
              "alone. Models with textures have the second limit of a first picture, %.1f s. Scene "
              "files are also shown with the 16 samples that pictures at rest get.",
              ask->width, ask->height, textured_goal.must);
    bench_file(bench, "filled", look.filled);
    bench_file(bench, "cache", look.cache);
    bench_file(bench, "replay", look.replay);
    bench_file(bench, "states", look.states);
    unsetenv("MESA_SHADER_CACHE_DIR");
    result = bench_write(bench, "replay", replay, sizeof replay - 1);
    if (result == WHIT_OK)
        result = fill_caches(&look);
    for (uint32_t i = 0; result == WHIT_OK && i < ask->name_count; ++i)
        result = run_model(&look, ask->names[i]);
    return table_end(&table, "First looks", result);
}

/* `whit bench shaders`: what follows a save of a user's file, by the library: the viewer's window,
   its looking at the file and its showing of a picture are not in the figures. */
#include <stdlib.h>
#include <string.h>

#include "bench/table.h"

enum { TEXT_BYTES = 1024, SPACING = 8 };

/* `%.9g` is another number in each save, so that no cache has the kernel. */
static const struct edited {
    const char *label, *text;
    bool traces;
} edits[] = {
    {"shade", "vec3 shade(Surface s, Optics o, vec3 to_eye) { return s.color * %.9g; }\n", false},
    {"surface", "void surface(inout Surface s) { s.ns = normalize(s.ns + %.9g * s.p.yzx); }\n",
     false},
    {"miss", "vec3 miss(vec3 dir) { return whit_miss(dir) * %.9g; }\n", false},
    {"post", "vec3 post(ivec2 at, vec3 color) { return color * %.9g; }\n", false},
    {"camera", "void camera(vec2 at, inout vec3 origin, inout vec3 dir) { dir.x += 0.1 * %.9g; }\n",
     false},
    {"shade, visible",
     "vec3 shade(Surface s, Optics o, vec3 to_eye) { return s.color * visible(s, s.ns, %.9g); }\n",
     true},
    {"scatter",
     "void scatter(Surface s, Optics o, inout Rays r) { r.reflected = vec3(0.1 * %.9g); }\n", true},
};
enum { EDITS = sizeof edits / sizeof *edits };

static const char looping[] =
    "vec3 miss(vec3 dir) { for (int i = 0; i < 20; ++i) dir = fract(dir * 3.7 + 0.1); return dir; "
    "}\n"
    "vec3 shade(Surface s, Optics o, vec3 to_eye) { vec3 sum = vec3(0.0); float x = s.u;\n"
    "    for (int i = 0; i < 20; ++i) { x = fract(x * 3.7 + 0.1); sum += sin(s.p * x); }\n"
    "    return sum * 0.05; }\n";
static const char broken[] = "vec3 miss(vec3 dir) { return vec3(%.9g) + dirr; }\n";

struct saves {
    struct bench *bench;
    struct bench_scene loaded;
    whit_accel *accel;
    whit_shader_compiler *compiler;
    whit_log silent;
    char path[BENCH_PATH];
    uint32_t number; /* of the save */
    double start_ms, first_ms;
    whit_shader *saved[EDITS]; /* the version before, and what draws with it */
    whit_renderer *drawing[EDITS];
    whit_shader *looping[2];
    whit_renderer *renderers[2]; /* with fuel, and trusted */
    struct sample_runs loops[2];
};

static whit_result save(struct saves *s, const char *form)
{
    char text[TEXT_BYTES];
    double number = 1.0 + 1e-3 * ++s->number + 1e-9 * (double)((uint64_t)whit_clock_ms() % 99991);
    snprintf(text, sizeof text, form, number); /* of the tables above */
    s->start_ms = whit_clock_ms();
    return whit_file_write(s->path, text, strlen(text), &cli_log);
}

static void note_first(void *user, const whit_step *step)
{
    struct saves *s = user;
    (void)step;
    s->first_ms = s->first_ms > 0.0 ? s->first_ms : whit_clock_ms() - s->start_ms;
}

static whit_renderer_params params_of(struct saves *s, const whit_shader *shader)
{
    whit_renderer_params params = whit_renderer_defaults();
    params.width = s->bench->ask.width;
    params.height = s->bench->ask.height;
    params.shader = shader;
    params.many_pictures = true;
    params.cancel = &cli_cancel;
    return params;
}

/* ---- Saves ---- */

struct save_times {
    struct sample_runs text, first, whole; /* to SPIR-V, to the first pixels, to the picture; ms */
};

/* As the viewer does: from the second version on in the place of the one before. */
static whit_result draw(struct saves *s, uint32_t edit, const whit_shader *shader)
{
    whit_renderer **renderer = &s->drawing[edit];
    whit_renderer_params params = params_of(s, shader);
    params.step = note_first;
    params.step_spacing = SPACING;
    params.progress_user = s;
    whit_result result = *renderer
                             ? whit_renderer_set_shader(*renderer, &params)
                             : whit_renderer_create(s->bench->device, s->accel, &params, renderer);
    return result == WHIT_OK ? whit_renderer_render(*renderer) : result;
}

static void forget_edits(struct saves *s)
{
    for (uint32_t i = 0; i < EDITS; ++i) {
        whit_renderer_destroy(s->drawing[i]);
        whit_shader_destroy(s->saved[i]);
        s->drawing[i] = NULL;
        s->saved[i] = NULL;
    }
}

static whit_result save_once(struct saves *s, uint32_t edit, struct save_times *times)
{
    whit_shader *shader = NULL;
    bool first = !s->drawing[edit];
    whit_result result = save(s, edits[edit].text);
    if (result == WHIT_OK)
        result = whit_shader_load(s->compiler, s->path, false, &shader);
    double text_ms = whit_clock_ms() - s->start_ms;
    s->first_ms = 0.0;
    if (result == WHIT_OK)
        result = draw(s, edit, shader);
    double whole_ms = whit_clock_ms() - s->start_ms;
    if (shader) {
        whit_shader_destroy(s->saved[edit]);
        s->saved[edit] = shader;
    }
    if (result != WHIT_OK || first)
        return result;
    sample_add(&times->text, text_ms);
    sample_add(&times->first, s->first_ms > 0.0 ? s->first_ms : whole_ms);
    sample_add(&times->whole, whole_ms);
    return bench_step(s->bench);
}

static double quantile(const struct sample_runs *runs, double share)
{
    double values[SAMPLE_RUNS_MAX];
    memcpy(values, runs->values, runs->count * sizeof *values);
    sample_sort(values, runs->count);
    return sample_quantile(values, runs->count, share);
}

static void put_times(struct table *table, json_t *row, const char *name,
                      const struct sample_runs *runs)
{
    json_t *times = document_object();
    document_number(times, "p50", quantile(runs, 0.5));
    document_number(times, "p95", quantile(runs, 0.95));
    document_count(times, "runs", runs->count);
    document_put(row, name, times);
    table_cell(table, "%.0f", quantile(runs, 0.5));
    table_cell(table, "%.0f", quantile(runs, 0.95));
}

static void put_row(struct table *table, const char *scene, const struct edited *edit,
                    const struct save_times *times)
{
    json_t *row = document_object();
    document_text(row, "scene", scene);
    document_text(row, "function", edit->label);
    document_flag(row, "traces", edit->traces);
    table_row(table);
    table_cell(table, "%s", scene);
    table_cell(table, "%s", edit->label);
    put_times(table, row, "text_ms", &times->text);
    put_times(table, row, "first_ms", &times->first);
    put_times(table, row, "whole_ms", &times->whole);
    table_keep(table, row);
}

static whit_result measure_saves(struct saves *s, struct table *table, const char *scene)
{
    struct save_times *times = calloc(EDITS, sizeof *times);
    whit_result result = times ? WHIT_OK : WHIT_ERROR_MEMORY;
    for (uint32_t round = 0; result == WHIT_OK && round <= s->bench->ask.runs; ++round) {
        for (uint32_t i = 0; result == WHIT_OK && i < EDITS; ++i)
            result = save_once(s, i, &times[i]);
    }
    forget_edits(s);
    for (uint32_t i = 0; result == WHIT_OK && i < EDITS; ++i)
        put_row(table, scene, &edits[i], &times[i]);
    free(times);
    return result;
}

/* ---- Fuel ---- */

static whit_result draw_loops(void *user, uint32_t way, uint32_t round)
{
    struct saves *s = user;
    whit_stats stats;
    whit_result result = whit_renderer_render(s->renderers[way]);
    whit_renderer_get_stats(s->renderers[way], &stats);
    if (result == WHIT_OK && round > 0) /* kernels are made in the first one */
        sample_add(&s->loops[way], stats.render_ms);
    return result;
}

static whit_result measure_fuel(struct saves *s, struct table *table, const char *scene)
{
    whit_result result = save(s, looping);
    memset(s->loops, 0, sizeof s->loops);
    for (int i = 0; result == WHIT_OK && i < 2; ++i) {
        result = whit_shader_load(s->compiler, s->path, i == 1, &s->looping[i]);
        if (result != WHIT_OK)
            break;
        const whit_renderer_params params = params_of(s, s->looping[i]);
        result = whit_renderer_create(s->bench->device, s->accel, &params, &s->renderers[i]);
    }
    if (result == WHIT_OK)
        result = sample_in_turns(2, s->bench->ask.runs + 1, draw_loops, s);
    for (int i = 0; i < 2; ++i) {
        whit_renderer_destroy(s->renderers[i]);
        whit_shader_destroy(s->looping[i]);
        s->renderers[i] = NULL;
        s->looping[i] = NULL;
    }
    if (result != WHIT_OK)
        return result;
    struct sample_runs ratio = sample_ratio(&s->loops[0], &s->loops[1]);
    table_say(table,
              "%s, two loops of 20 in each call, %u pairs of pictures: %.0f ms with fuel, %.0f ms "
              "with --trust; the median ratio is %.3f.",
              scene, ratio.count, sample_of(&s->loops[0]).median, sample_of(&s->loops[1]).median,
              sample_of(&ratio).median);
    return WHIT_OK;
}

/* ---- Errors ---- */

static whit_result measure_errors(struct saves *s, struct table *table)
{
    struct sample_runs times = {.count = 0};
    whit_result result = WHIT_OK;
    for (uint32_t i = 0; result == WHIT_OK && i < s->bench->ask.runs; ++i) {
        whit_shader *shader = NULL;
        result = save(s, broken);
        if (result != WHIT_OK)
            break;
        bool refused = whit_shader_load(s->compiler, s->path, false, &shader) == WHIT_ERROR_INPUT;
        sample_add(&times, whit_clock_ms() - s->start_ms);
        whit_shader_destroy(shader);
        result = refused ? WHIT_OK : WHIT_ERROR_FAILED;
    }
    if (result == WHIT_OK)
        table_say(table, "From a save to the text of its error: p50 %.0f ms, p95 %.0f ms of %u.",
                  quantile(&times, 0.5), quantile(&times, 0.95), times.count);
    return result;
}

/* ---- Both scenes ---- */

static whit_result run_scene(struct saves *s, struct table *table, const char *scene)
{
    char path[BENCH_PATH];
    whit_result result = bench_find(s->bench, scene, path);
    if (result == WHIT_OK)
        result = bench_load(path, &s->loaded);
    if (result == WHIT_OK)
        result = whit_accel_create(s->loaded.scene, NULL, &s->accel);
    if (result == WHIT_OK)
        result = measure_saves(s, table, scene);
    if (result == WHIT_OK)
        result = measure_fuel(s, table, scene);
    whit_accel_destroy(s->accel);
    s->accel = NULL;
    bench_unload(&s->loaded);
    return result;
}

whit_result bench_shaders(struct bench *bench)
{
    static const char *const scenes[] = {"34k", "default"};
    static const char *const heads[] = {"scene", "function",  "SPIR-V p50", "p95", "first p50",
                                        "p95",   "whole p50", "p95, ms",    NULL};
    struct table table;
    struct saves *s = calloc(1, sizeof *s);
    if (!s)
        return WHIT_ERROR_MEMORY;
    s->bench = bench;
    bench_file(bench, "edited.glsl", s->path);
    table_begin(&table, bench, "shaders", heads, false, 2 * EDITS * bench->ask.runs);
    table_say(&table,
              "From a save to SPIR-V, to the first pixels (every %d-th) and to the whole "
              "picture, by the library: without the window; a version takes the place of "
              "the one before.",
              SPACING);
    whit_result result = whit_shader_compiler_create(NULL, &s->silent, &s->compiler);
    for (int i = 0; result == WHIT_OK && i < 2; ++i)
        result = run_scene(s, &table, scenes[i]);
    if (result == WHIT_OK)
        result = measure_errors(s, &table);
    whit_shader_compiler_destroy(s->compiler);
    free(s);
    return table_end(&table, "Saves of a shader", result);
}

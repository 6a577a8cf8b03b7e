/* `whit bench shaders`: measures what follows when a shader's file is saved. A `whit view` with a
   window, driven by a replay, reloads the saved file; the cost of fuel (the limit on loops) is
   measured by the library. */
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include "base/file.h"
#include "base/random.h"
#include "bench/process.h"
#include "bench/table.h"

enum { TEXT_BYTES = 1024, MOVES = 60, MOVES_QUICK = 8, MOVE_MS = 16, HELD_SAVES = 2 };
enum { PATIENCE_S = 60 }; /* time to wait for a window that prints nothing */

/* `%.9g` is replaced by another number in each save, so that no cache has the kernel. */
static const struct edited {
    const char *label, *text;
    const char *aov; /* the aov that the window shows; NULL: the colour */
    bool traces;
} edits[] = {
    {"shade", "vec3 shade(Surface s, Optics o, vec3 to_eye) { return s.color * %.9g; }\n", NULL,
     false},
    {"surface", "void surface(inout Surface s) { s.ns = normalize(s.ns + %.9g * s.p.yzx); }\n",
     NULL, false},
    {"miss", "vec3 miss(vec3 dir) { return whit_miss(dir) * %.9g; }\n", NULL, false},
    {"aov", "//@ aov height\nvec4 height(Surface s) { return vec4(s.p * %.9g, 1.0); }\n", "height",
     false},
    {"post", "vec3 post(ivec2 at, vec3 color) { return color * %.9g; }\n", NULL, false},
    {"shade, lit",
     "vec3 shade(Surface s, Optics o, vec3 to_eye)\n{\n"
     "    vec3 sum = o.emission + o.ambient * ambient();\n"
     "    for (uint i = 0u; i < light_count(); i++) {\n"
     "        Light l = light(i, 0u, s);\n"
     "        float shine = pow(max(dot(reflect(-l.dir, s.ns), to_eye), 0.0), o.shininess);\n"
     "        float cosine = max(dot(s.ns, l.dir), 0.0);\n"
     "        sum += (o.diffuse + o.highlight * shine) * l.arriving * cosine * %.9g;\n"
     "    }\n    return sum;\n}\n",
     NULL, false},
    {"shade, visible",
     "vec3 shade(Surface s, Optics o, vec3 to_eye) { return s.color * visible(s, s.ns, %.9g); }\n",
     NULL, true},
    {"intersect",
     "//@ box -3 -3 -3  3 3 3  0.01\n"
     "bool intersect(vec3 origin, vec3 dir, float far, out float t, out vec3 normal)\n{\n"
     "    t = 0.0;\n    normal = -dir;\n"
     "    for (int i = 0; i < 64 && t <= far; ++i) {\n"
     "        float d = length(origin + t * dir) - %.9g;\n"
     "        if (d < 0.01) { normal = normalize(origin + t * dir); return true; }\n"
     "        t += d;\n    }\n    return false;\n}\n",
     NULL, true},
};
enum { EDITS = sizeof edits / sizeof *edits };

static const char looping[] =
    "vec3 miss(vec3 dir) { for (int i = 0; i < 20; ++i) dir = fract(dir * 3.7 + 0.1); return dir; "
    "}\n"
    "vec3 shade(Surface s, Optics o, vec3 to_eye) { vec3 sum = vec3(0.0); float x = s.u;\n"
    "    for (int i = 0; i < 20; ++i) { x = fract(x * 3.7 + 0.1); sum += sin(s.p * x); }\n"
    "    return sum * 0.05; }\n";
static const char broken[] = "vec3 miss(vec3 dir) { return vec3(%.9g) + dirr; }\n";

/* Limits in seconds after a save: to the first changed picture, by whether the file traces rays; to
   the whole picture, by scene and function. Other scenes have no limits. */
static const double FIRST_MUST_S = 0.15, FIRST_TRACES_MUST_S = 0.35;
static const double INTERSECT_MUST_S = 1.2;
static const double ERROR_MUST_S = 0.05, FUEL_MUST = 1.02, TESTS_MUST_S = 2.0;
static const struct stage_must {
    const char *scene;
    double whole_s;
} musts[] = {{"34k", 0.6}, {"default", 1.2}};
enum { MUSTS = sizeof musts / sizeof *musts };

enum { TESTS = 10, CHECKS_EACH = 100 };

/* The figures of a scene that have limits; 0: not run. */
struct reached {
    double saves_ms[EDITS][2]; /* 95th percentile to the first and to the whole picture */
    double error_ms, fuel, tests_ms;
};

struct saves {
    struct bench *bench;
    struct reached reached[MUSTS + 1]; /* the last one is of scenes that have no limits */
    struct bench_scene loaded;
    whit_shader_compiler *compiler;
    whit_log silent;
    char path[BENCH_PATH];
    uint64_t numbers; /* state of splitmix64 */
    bool with_errors; /* the rounds in a window end with saves of an error */
    double start_ms;
    whit_shader *looping[2];
    whit_renderer *renderers[2]; /* with fuel; trusted, without fuel */
    struct sample_runs loops[2], errors, tests;
};

/* The next of numbers in [1, 17/16), since the shape of `intersect` has to stay in its box. Other
   runs have others: the driver keeps kernels in files. */
static double next_number(struct saves *s)
{
    return 1.0 + splitmix64_unit(&s->numbers) / 16.0;
}

/* Saves a version of the file. */
static whit_result save(struct saves *s, const char *form)
{
    char text[TEXT_BYTES];
    snprintf(text, sizeof text, form, next_number(s)); /* the format is from the tables above */
    s->start_ms = whit_clock_ms();
    return file_write_whole(&cli_log, s->path, text, strlen(text));
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

/* Use of the mouse while a version is compiled: it rests, moves over the picture, or drags it.
   HAND_ERROR: the saved file has an error. */
enum hand { HAND_NONE, HAND_OVER, HAND_DRAGS, HAND_ERROR };

/* The longest times of each round in which the mouse moves, ms. */
struct hand_times {
    struct sample_runs over, drags; /* between two frames of the window */
    struct sample_runs pictures;    /* between two new pictures while the view is dragged */
};

struct save_times {
    struct sample_runs first, whole; /* from the save to the first changed and to the whole picture,
                                        ms */
    struct hand_times saved, alone;  /* in rounds with a save, and in rounds without */
};

struct viewer {
    struct process process;
    FILE *states;
    char replay[BENCH_PATH], err[BENCH_PATH];
};

/* The rounds in a window, in order: mouse moves without a save; one save that starts the second
   session, then saves that are timed; saves during mouse moves; saves with an error. */
enum { ALONE = 2 };
static enum hand hand_of(const struct saves *s, uint32_t at)
{
    uint32_t timed = ALONE + s->bench->ask.runs + 1;
    uint32_t held = s->bench->ask.quick ? 1 : HELD_SAVES;
    return at < ALONE              ? (at == 0 ? HAND_OVER : HAND_DRAGS)
           : at < timed            ? HAND_NONE
           : at < timed + held     ? HAND_OVER
           : at < timed + 2 * held ? HAND_DRAGS
                                   : HAND_ERROR;
}

static uint32_t count_rounds(const struct saves *s)
{
    uint32_t count = ALONE + s->bench->ask.runs + 1;
    while (hand_of(s, count) != HAND_ERROR)
        ++count;
    return count + (s->with_errors ? s->bench->ask.runs : 0);
}

static bool is_held(enum hand hand)
{
    return hand == HAND_OVER || hand == HAND_DRAGS;
}

static void write_hand(FILE *to, const struct saves *s, enum hand hand)
{
    int moves = s->bench->ask.quick ? MOVES_QUICK : MOVES;
    if (hand == HAND_DRAGS)
        fprintf(to, "button left down\n");
    for (int i = 1; i <= moves; ++i)
        fprintf(to, "move %d %d\nwait %d\n", 20 + 2 * i, 20 + i, MOVE_MS);
    fprintf(to, "state moved\n");
    if (hand == HAND_DRAGS)
        fprintf(to, "button left up\n");
}

/* Writes the replay. Each state `saved` tells the bench to save again, and has the figures of the
   save before; `moved` has the figures of the mouse moves. */
static void put_replay(FILE *to, const void *user)
{
    const struct saves *s = user;
    uint32_t first = 0, refused = 0;
    fprintf(to, "clock real\nmove 20 20\nstill\nstate ready\n");
    for (uint32_t i = 0; i < count_rounds(s); ++i) {
        enum hand hand = hand_of(s, i);
        if (is_held(hand))
            write_hand(to, s, hand);
        if (hand == HAND_ERROR)
            fprintf(to, "until shader.refused = %u\n", ++refused);
        else if (i >= ALONE)
            fprintf(to, "until shader.first = %u\n", ++first);
        if (hand != HAND_ERROR)
            fprintf(to, "still\n");
        fprintf(to, "state saved\nmove 20 20\n"); /* the move ends the measurement of the change */
    }
}

static whit_result start_viewer(const struct saves *s, const char *scene, const struct edited *edit,
                                struct viewer *viewer)
{
    int ends[2];
    char size[32];
    const struct bench *bench = s->bench;
    snprintf(size, sizeof size, "%ux%u", bench->ask.width, bench->ask.height);
    const struct timeval patience = {.tv_sec = PATIENCE_S};
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
        return WHIT_ERROR_OUTPUT;
    setsockopt(ends[0], SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    bench_file(bench, "messages", viewer->err);
    viewer->process =
        (struct process){.program = bench->whit, .socket = ends[1], .err = viewer->err};
    process_add(&viewer->process, "whit", "view", scene, "--shader", s->path, "--size", size,
                "--quiet", "--replay", viewer->replay, "--no-vsync", "--remember", "no", NULL);
    if (edit->aov)
        process_add(&viewer->process, "--aov", edit->aov, NULL);
    process_add_device(&viewer->process, bench);
    whit_result result = process_start(&viewer->process);
    close(ends[1]);
    viewer->states = fdopen(ends[0], "r");
    return result == WHIT_OK && !viewer->states ? WHIT_ERROR_MEMORY : result;
}

/* Reads the next state, which the caller releases; NULL: the viewer has ended, or printed nothing
   for too long, such as after a save that it refuses. */
static json_t *read_state(struct viewer *viewer)
{
    return json_loadf(viewer->states, JSON_DISABLE_EOF_CHECK, NULL);
}

static double number_at(const json_t *state, const char *group, const char *name, const char *part)
{
    const json_t *value = json_object_get(json_object_get(state, group), name);
    return json_number_value(part ? json_object_get(value, part) : value);
}

static void note_save(struct saves *s, enum hand hand, const json_t *state,
                      struct save_times *times)
{
    if (hand == HAND_ERROR)
        sample_add(&s->errors, number_at(state, "shader", "error_ms", NULL) - s->start_ms);
    if (hand != HAND_NONE)
        return;
    sample_add(&times->first, number_at(state, "shader", "first_ms", NULL) - s->start_ms);
    sample_add(&times->whole, number_at(state, "shader", "whole_ms", NULL) - s->start_ms);
}

static void note_hand(enum hand hand, const json_t *state, struct hand_times *times)
{
    double between_ms = number_at(state, "measure", "between_ms", "max");
    sample_add(hand == HAND_OVER ? &times->over : &times->drags, between_ms);
    if (hand == HAND_DRAGS)
        sample_add(&times->pictures, number_at(state, "measure", "gap_ms", "max"));
}

/* Waits a second, as a person looks at the last picture before saving again. Without it a save
   would fall into the moment in which the window compares two pictures. */
static void look_on(void)
{
    nanosleep(&(struct timespec){.tv_sec = 1}, NULL);
}

/* One round: a save, except in the first rounds, and the viewer's figures for it. */
static whit_result watch_round(struct saves *s, struct viewer *viewer, const struct edited *edit,
                               uint32_t at, struct save_times *times)
{
    enum hand hand = hand_of(s, at);
    json_t *state = NULL;
    if (hand == HAND_NONE && !s->bench->ask.quick)
        look_on();
    whit_result result = at < ALONE ? WHIT_OK : save(s, hand == HAND_ERROR ? broken : edit->text);
    if (result == WHIT_OK && is_held(hand)) {
        state = read_state(viewer);
        note_hand(hand, state, at < ALONE ? &times->alone : &times->saved);
        json_decref(state);
    }
    if (result == WHIT_OK)
        state = read_state(viewer);
    if (result == WHIT_OK && !state)
        result = WHIT_ERROR_FAILED;
    if (result == WHIT_OK && at > ALONE)
        note_save(s, hand, state, times);
    json_decref(state);
    return result == WHIT_OK ? bench_step(s->bench) : result;
}

/* Runs all rounds for one function in one window. */
static whit_result watch_saves(struct saves *s, struct viewer *viewer, const struct edited *edit,
                               struct save_times *times)
{
    json_t *state = read_state(viewer);
    whit_result result = state ? WHIT_OK : WHIT_ERROR_FAILED;
    json_decref(state);
    for (uint32_t i = 0; result == WHIT_OK && i < count_rounds(s); ++i)
        result = watch_round(s, viewer, edit, i, times);
    return result;
}

static whit_result view_saves(struct saves *s, const char *scene, uint32_t edit,
                              struct save_times *times)
{
    struct viewer viewer = {.states = NULL};
    bench_file(s->bench, "replay", viewer.replay);
    whit_result result = document_save_written(viewer.replay, put_replay, s);
    if (result == WHIT_OK)
        result = save(s, edits[edit].text);
    if (result == WHIT_OK)
        result = start_viewer(s, scene, &edits[edit], &viewer);
    if (result == WHIT_OK)
        result = watch_saves(s, &viewer, &edits[edit], times);
    if (viewer.states)
        fclose(viewer.states);
    if (result != WHIT_OK && viewer.process.pid > 0)
        kill(viewer.process.pid, SIGKILL); /* the viewer waits for something that does not come;
                                              process_end quotes its last message */
    whit_result end = viewer.process.pid > 0 ? process_end(&viewer.process, NULL) : WHIT_OK;
    return end == WHIT_OK ? result : end;
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
    json_t *times = document_child(row, name);
    document_number(times, "p50", quantile(runs, 0.5));
    document_number(times, "p95", quantile(runs, 0.95));
    document_count(times, "runs", runs->count);
    table_cell(table, "%.0f", quantile(runs, 0.5));
    table_cell(table, "%.0f", quantile(runs, 0.95));
}

/* Adds the longest times of rounds with saves and of rounds without. */
static void put_max(struct table *table, json_t *row, const char *name,
                    const struct sample_runs *saved, const struct sample_runs *alone)
{
    json_t *times = document_child(row, name);
    document_number(times, "saved", quantile(saved, 1.0));
    document_number(times, "alone", quantile(alone, 1.0));
    table_cell(table, "%.0f, %.0f", quantile(saved, 1.0), quantile(alone, 1.0));
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
    put_times(table, row, "first_ms", &times->first);
    put_times(table, row, "whole_ms", &times->whole);
    put_max(table, row, "gap_over_ms", &times->saved.over, &times->alone.over);
    put_max(table, row, "gap_drags_ms", &times->saved.drags, &times->alone.drags);
    put_max(table, row, "gap_pictures_ms", &times->saved.pictures, &times->alone.pictures);
    table_keep(table, row);
}

static struct reached *reached_of(struct saves *s, const char *scene)
{
    size_t i = 0;
    while (i < MUSTS && strcmp(musts[i].scene, scene) != 0)
        ++i;
    return &s->reached[i];
}

/* Errors are measured only with the first function, as the broken file is the same for all. */
static whit_result measure_saves(struct saves *s, struct table *table, const char *scene,
                                 const char *path)
{
    struct reached *reached = reached_of(s, scene);
    whit_result result = WHIT_OK;
    for (uint32_t i = 0; result == WHIT_OK && i < EDITS; ++i) {
        struct save_times times = {.first = {.count = 0}};
        s->with_errors = i == 0;
        result = view_saves(s, path, i, &times);
        if (result == WHIT_OK) {
            put_row(table, scene, &edits[i], &times);
            reached->saves_ms[i][0] = quantile(&times.first, 0.95);
            reached->saves_ms[i][1] = quantile(&times.whole, 0.95);
        }
    }
    return result;
}

/* ---- Fuel ---- */

static whit_result draw_loops(void *user, uint32_t way, uint32_t round)
{
    struct saves *s = user;
    whit_stats stats;
    whit_result result = whit_renderer_render(s->renderers[way]);
    whit_renderer_get_stats(s->renderers[way], &stats);
    if (result == WHIT_OK && round > 0) /* kernels are made in the first round */
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
        result = whit_renderer_create(s->bench->device, s->loaded.accel, &params, &s->renderers[i]);
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
    reached_of(s, scene)->fuel = sample_of(&ratio).median;
    return WHIT_OK;
}

/* ---- Tests ---- */

/* Writes a file of tests with other numbers each time, so that no cache has the kernel. */
static whit_result write_tests(struct saves *s)
{
    char *text = NULL;
    size_t bytes = 0;
    FILE *to = open_memstream(&text, &bytes);
    if (!to)
        return WHIT_ERROR_MEMORY;
    for (uint32_t i = 0; i < TESTS; ++i) {
        fprintf(to, "//@ test\nvoid t%u(uint seed)\n{\n    float x = float(seed);\n", i);
        for (uint32_t k = 0; k < CHECKS_EACH; ++k)
            fprintf(to, "    check(x * %.9g >= x);\n", next_number(s));
        fprintf(to, "}\n");
    }
    fprintf(to, "vec3 miss(vec3 dir) { return dir; }\n");
    whit_result result =
        fclose(to) == 0 ? file_write_whole(&cli_log, s->path, text, bytes) : WHIT_ERROR_MEMORY;
    free(text);
    return result;
}

/* Loads, compiles and runs the file of tests. */
static whit_result run_tests(struct saves *s, whit_shader **shader, whit_renderer **renderer)
{
    static whit_check_result results[TESTS * CHECKS_EACH];
    double compile_ms, run_ms;
    whit_result result = whit_shader_load(s->compiler, s->path, false, shader);
    if (result == WHIT_OK)
        result = whit_shader_compile_tests(s->compiler, *shader);
    const whit_renderer_params params = params_of(s, *shader);
    if (result == WHIT_OK)
        result = whit_renderer_create(s->bench->device, s->loaded.accel, &params, renderer);
    if (result == WHIT_OK)
        result = whit_renderer_run_tests(*renderer, results, &compile_ms, &run_ms);
    for (int i = 0; result == WHIT_OK && i < TESTS * CHECKS_EACH; ++i) {
        if (!results[i].reached || results[i].failed)
            result = WHIT_ERROR_FAILED;
    }
    return result;
}

static whit_result measure_tests(struct saves *s, struct table *table, const char *scene)
{
    whit_result result = WHIT_OK;
    s->tests.count = 0;
    for (uint32_t i = 0; result == WHIT_OK && i < s->bench->ask.runs; ++i) {
        whit_shader *shader = NULL;
        whit_renderer *renderer = NULL;
        result = write_tests(s);
        double start_ms = whit_clock_ms();
        if (result == WHIT_OK)
            result = run_tests(s, &shader, &renderer);
        sample_add(&s->tests, whit_clock_ms() - start_ms);
        whit_renderer_destroy(renderer);
        whit_shader_destroy(shader);
    }
    if (result != WHIT_OK)
        return result;
    table_say(table, "%s, %d checks of %d seeds, from the file on: p50 %.0f ms, p95 %.0f ms of %u.",
              scene, TESTS * CHECKS_EACH, WHIT_TEST_SEEDS, quantile(&s->tests, 0.5),
              quantile(&s->tests, 0.95), s->tests.count);
    reached_of(s, scene)->tests_ms = quantile(&s->tests, 0.95);
    return WHIT_OK;
}

/* ---- Scenes ---- */

static whit_result run_scene(struct saves *s, struct table *table, const char *scene)
{
    char path[BENCH_PATH];
    s->errors.count = 0;
    whit_result result = bench_find(s->bench, scene, path);
    if (result == WHIT_OK)
        result = measure_saves(s, table, scene, path);
    if (result == WHIT_OK)
        table_say(table,
                  "%s, from a save to its error in the window: p50 %.0f ms, p95 %.0f ms of %u.",
                  scene, quantile(&s->errors, 0.5), quantile(&s->errors, 0.95), s->errors.count);
    if (result == WHIT_OK)
        reached_of(s, scene)->error_ms = quantile(&s->errors, 0.95);
    if (result == WHIT_OK)
        result = bench_load_trees(path, &s->loaded);
    if (result == WHIT_OK)
        result = measure_fuel(s, table, scene);
    if (result == WHIT_OK)
        result = measure_tests(s, table, scene);
    bench_unload(&s->loaded);
    return result;
}

/* Adds rows that compare the times of one function in one scene with their limits. */
static void put_must(struct table *table, const struct stage_must *must, const struct edited *edit,
                     const double reached_ms[2])
{
    static const char *const what[2] = {"first", "whole"};
    bool intersects = strcmp(edit->label, "intersect") == 0;
    const double must_s[2] = {edit->traces ? FIRST_TRACES_MUST_S : FIRST_MUST_S,
                              intersects ? INTERSECT_MUST_S : must->whole_s};
    for (int i = 0; i < 2; ++i) {
        char name[80];
        snprintf(name, sizeof name, "%s, %s: %s", must->scene, edit->label, what[i]);
        table_goal(table, "save", name, reached_ms[i] * 1e-3, "s",
                   (struct goal){must_s[i], must_s[i], false});
    }
}

static void put_rest(struct table *table, const struct stage_must *must,
                     const struct reached *reached)
{
    const struct {
        const char *what, *unit;
        double value, must;
    } rows[] = {{"error", "s", reached->error_ms * 1e-3, ERROR_MUST_S},
                {"fuel, median", "", reached->fuel, FUEL_MUST},
                {"1000 checks", "s", reached->tests_ms * 1e-3, TESTS_MUST_S}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        char name[80];
        snprintf(name, sizeof name, "%s: %s", must->scene, rows[i].what);
        table_goal(table, "save", name, rows[i].value, rows[i].unit,
                   (struct goal){rows[i].must, rows[i].must, false});
    }
}

static whit_result judge(const struct saves *s)
{
    static const char *const heads[] = {"save", NULL};
    struct table table;
    bool has_any = false;
    for (int i = 0; i < MUSTS; ++i)
        has_any |= s->reached[i].saves_ms[0][0] > 0.0;
    if (!has_any)
        return WHIT_OK;
    table_begin(&table, s->bench, "shaders_goals", heads, true, 1);
    for (int i = 0; i < MUSTS; ++i) {
        for (uint32_t k = 0; k < EDITS && s->reached[i].saves_ms[k][0] > 0.0; ++k)
            put_must(&table, &musts[i], &edits[k], s->reached[i].saves_ms[k]);
        if (s->reached[i].tests_ms > 0.0)
            put_rest(&table, &musts[i], &s->reached[i]);
    }
    return table_end(&table, "What 95 % of the saves must reach", WHIT_OK);
}

whit_result bench_shaders(struct bench *bench)
{
    static const char *const usual[] = {"34k", "default"};
    static const char *const heads[] = {
        "scene",           "function",     "first p50",         "p95", "whole p50", "p95",
        "gap, mouse over", "gap, dragged", "gap, pictures, ms", NULL};
    const struct bench_request *ask = &bench->ask;
    const char *const *scenes = ask->name_count ? ask->names : usual;
    uint32_t count = ask->name_count ? ask->name_count : 2;
    struct table table;
    struct saves *s = calloc(1, sizeof *s);
    if (!s)
        return WHIT_ERROR_MEMORY;
    s->bench = bench;
    s->numbers = (uint64_t)time(NULL);
    bench_file(bench, "edited.glsl", s->path);
    table_begin(&table, bench, "shaders", heads, false,
                count * (EDITS * count_rounds(s) + ask->runs));
    table_say(
        &table,
        "From a save to the first changed picture on the screen and to the whole one, in the "
        "viewer's window, a second after it stood still; a version takes the place of the one "
        "before last.");
    table_say(
        &table,
        "Gaps: the most from one drawing of the window to the next in %.1f s from a save on, "
        "while the mouse moves over the picture, or drags it; and from one new picture to the "
        "next while it is dragged. Behind the comma: the same without a save.",
        (bench->ask.quick ? MOVES_QUICK : MOVES) * MOVE_MS * 1e-3);
    whit_result result = whit_shader_compiler_create(NULL, &s->silent, &s->compiler);
    for (uint32_t i = 0; result == WHIT_OK && i < count; ++i)
        result = run_scene(s, &table, scenes[i]);
    whit_shader_compiler_destroy(s->compiler);
    result = table_end(&table, "Saves of a shader", result);
    if (result == WHIT_OK)
        result = judge(s);
    free(s);
    return result;
}

#define _GNU_SOURCE
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/bench/bench.h"

/* ---- Scenes ---- */

/* Beside the program, where it is built or installed. */
static bool find_beside_program(const char *name, char *path, size_t size)
{
    static const char *const folders[] = {"../scenes", "../../scenes", "../share/whit/scenes"};
    char program[2048];
    ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    if (length <= 0)
        return false;
    program[length] = 0;
    char *slash = strrchr(program, '/');
    if (!slash)
        return false;
    *slash = 0;
    for (size_t i = 0; i < sizeof folders / sizeof folders[0]; ++i) {
        snprintf(path, size, "%s/%s/%s.json", program, folders[i], name);
        if (access(path, R_OK) == 0)
            return true;
    }
    return false;
}

whit_result bench_load_file(const char *path, struct bench_scene *scene)
{
    const whit_load_params params = {.cancel = &cli_cancel};
    whit_result result = whit_scene_load(path, &params, &cli_log_errors, &scene->scene);
    if (result == WHIT_OK)
        whit_scene_get_info(scene->scene, &scene->info);
    return result == WHIT_OK && cli_cancel ? WHIT_ERROR_CANCELLED : result;
}

whit_result bench_find(const struct bench *bench, const char *name, char *path, size_t bytes)
{
    snprintf(path, bytes, "%s/%s.json", bench->scenes ? bench->scenes : "scenes", name);
    if (!bench->scenes && access(path, R_OK) != 0 && !find_beside_program(name, path, bytes)) {
        cli_error("%s.json is not here: --scenes FOLDER says where whit's scenes are", name);
        return WHIT_ERROR_INPUT;
    }
    return WHIT_OK;
}

whit_result bench_load(const struct bench *bench, const char *name, struct bench_scene *scene)
{
    char path[BENCH_PATH];
    *scene = (struct bench_scene){0};
    snprintf(scene->name, sizeof scene->name, "%s", name);
    if (bench_find(bench, name, path, sizeof path) != WHIT_OK)
        return WHIT_ERROR_INPUT;
    return bench_load_file(path, scene);
}

void bench_unload(struct bench_scene *scene)
{
    whit_scene_destroy(scene->scene);
    *scene = (struct bench_scene){0};
}

/* ---- Progress ---- */

void bench_begin(struct bench *bench, uint32_t steps)
{
    cli_progress_init(&bench->progress, bench->settings.quiet);
    bench->step = 0;
    bench->step_count = steps;
}

void bench_step(struct bench *bench)
{
    ++bench->step;
    cli_progress_update(&bench->progress, (double)bench->step / bench->step_count);
}

void bench_end(struct bench *bench)
{
    cli_progress_finish(&bench->progress);
}

/* ---- Figures ---- */

int bench_compare(const struct sample_runs *a, const struct sample_runs *b)
{
    double differences[SAMPLE_RUNS_MAX];
    uint32_t count = a->count < b->count ? a->count : b->count;
    return sample_compare(a->values, b->values, count, differences, NULL);
}

double bench_fps(const struct bench_case *c)
{
    double ms = sample_of(&c->frame).median;
    return ms > 0.0 ? 1e3 / ms : 0.0;
}

static double sum_of_costs(const struct bench_case *c, double *rays, double *triangles)
{
    double visits = 0.0;
    *rays = *triangles = 0.0;
    for (int kind = 0; kind < WHIT_RAY_KINDS; ++kind) {
        const whit_cost *cost = &c->counted.costs[kind];
        *rays += (double)cost->rays;
        *triangles += (double)cost->triangles;
        visits += (double)(cost->inner_nodes + cost->leaves + cost->instances);
    }
    return visits;
}

double bench_visits(const struct bench_case *c)
{
    double rays, triangles, visits = sum_of_costs(c, &rays, &triangles);
    return rays > 0.0 ? visits / rays : 0.0;
}

double bench_triangle_tests(const struct bench_case *c)
{
    double rays, triangles;
    sum_of_costs(c, &rays, &triangles);
    return rays > 0.0 ? triangles / rays : 0.0;
}

static json_t *times_document(const struct sample_runs *times)
{
    json_t *object = document_object();
    document_ms(object, "median", sample_of(times).median);
    document_ms(object, "spread", sample_of(times).spread);
    document_count(object, "runs", times->count);
    return object;
}

static void put_counts(json_t *object, const struct bench_case *c)
{
    const whit_cost *primary = &c->counted.costs[WHIT_RAY_PRIMARY];
    document_number(object, "visits_per_ray", bench_visits(c));
    document_number(object, "triangle_tests_per_ray", bench_triangle_tests(c));
    if (primary->records)
        document_number(object, "depth_mean",
                        (double)primary->depth_sum / (double)primary->records);
    document_count(object, "depth_max", primary->depth);
}

json_t *bench_document(const struct bench_case *c)
{
    json_t *object = document_object();
    document_text(object, "case", c->label);
    document_text(object, "scene", c->scene->name);
    document_count(object, "triangles", c->scene->info.triangle_count);
    if (c->build.count)
        document_put(object, "build_ms", times_document(&c->build));
    if (c->frame.count) {
        document_put(object, "frame_ms", times_document(&c->frame));
        document_number(object, "fps", bench_fps(c));
        document_count(object, "width", c->width);
        document_count(object, "height", c->height);
    }
    if (c->accel_info.node_count) {
        document_number(object, "sah_cost", c->accel_info.sah_cost);
        document_count(object, "nodes", c->accel_info.node_count);
        document_count(object, "references", c->accel_info.reference_count);
        document_count(object, "depth", c->accel_info.depth);
    }
    if (c->has_counts)
        put_counts(object, c);
    return object;
}

/* ---- Runs ---- */

/* Cases of one section, measured in turns. */
struct turns {
    struct bench *bench;
    struct bench_case *cases;
};

static whit_result build_once(void *user, uint32_t index, uint32_t run)
{
    const struct turns *turns = user;
    struct bench_case *c = &turns->cases[index];
    (void)run;
    whit_accel_destroy(c->accel);
    c->accel = NULL;
    whit_result result = whit_accel_create(c->scene->scene, &c->accel_params, &c->accel);
    if (result != WHIT_OK)
        return result;
    whit_accel_get_info(c->accel, &c->accel_info);
    sample_add(&c->build, c->accel_info.build_ms);
    bench_step(turns->bench);
    return cli_cancel ? WHIT_ERROR_CANCELLED : WHIT_OK;
}

whit_result bench_build(struct bench *bench, struct bench_case *cases, uint32_t count,
                        uint32_t runs)
{
    struct turns turns = {.bench = bench, .cases = cases};
    return sample_in_turns(count, runs, build_once, &turns);
}

static whit_result create_renderer(struct bench *bench, struct bench_case *c, bool counting,
                                   whit_renderer **renderer)
{
    c->width = c->width ? c->width : bench->width;
    c->height = c->height ? c->height : bench->height;
    const whit_renderer_params params = {
        .width = c->width,
        .height = c->height,
        .traversal = c->traversal,
        .effects = c->effects,
        .count = counting,
        .cancel = &cli_cancel,
    };
    return whit_renderer_create(bench->device, c->accel, &params, renderer);
}

static whit_result render_once(struct bench *bench, struct bench_case *c, bool timed)
{
    whit_stats stats;
    whit_result result = whit_renderer_render(c->renderer);
    if (result != WHIT_OK)
        return result;
    whit_renderer_get_stats(c->renderer, &stats);
    if (timed)
        sample_add(&c->frame, stats.render_ms);
    bench_step(bench);
    return cli_cancel ? WHIT_ERROR_CANCELLED : WHIT_OK;
}

/* The first run warms up. */
static whit_result render_run(void *user, uint32_t index, uint32_t run)
{
    const struct turns *turns = user;
    return render_once(turns->bench, &turns->cases[index], run > 0);
}

static void keep_counts(struct bench_case *c)
{
    whit_renderer_get_stats(c->renderer, &c->counted);
    c->has_counts = true;
}

whit_result bench_render(struct bench *bench, struct bench_case *cases, uint32_t count,
                         uint32_t runs)
{
    whit_result result = WHIT_OK;
    for (uint32_t i = 0; result == WHIT_OK && i < count; ++i)
        result = create_renderer(bench, &cases[i], bench->quick, &cases[i].renderer);
    struct turns turns = {.bench = bench, .cases = cases};
    if (result == WHIT_OK)
        result = sample_in_turns(count, runs + 1, render_run, &turns);
    for (uint32_t i = 0; i < count; ++i) {
        if (result == WHIT_OK && bench->quick)
            keep_counts(&cases[i]);
        whit_renderer_destroy(cases[i].renderer);
        cases[i].renderer = NULL;
    }
    return result;
}

whit_result bench_count(struct bench *bench, struct bench_case *cases, uint32_t count)
{
    whit_result result = WHIT_OK;
    for (uint32_t i = 0; result == WHIT_OK && i < count; ++i) {
        struct bench_case *c = &cases[i];
        if (c->has_counts)
            continue;
        result = create_renderer(bench, c, true, &c->renderer);
        if (result == WHIT_OK)
            result = render_once(bench, c, false);
        if (result == WHIT_OK)
            keep_counts(c);
        whit_renderer_destroy(c->renderer);
        c->renderer = NULL;
    }
    return result;
}

void bench_case_finish(struct bench_case *cases, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i) {
        whit_renderer_destroy(cases[i].renderer);
        whit_accel_destroy(cases[i].accel);
    }
}

#include "bench/cases.h"

#include <math.h>
#include <string.h>

#include "bench/table.h"

/* ---- Figures ---- */

double case_fps(const struct bench_case *c)
{
    double ms = sample_of(&c->frame).median;
    return ms > 0.0 ? 1e3 / ms : 0.0;
}

static double a_ray(const struct bench_case *c, double of)
{
    double rays = 0.0;
    for (int kind = 0; kind < WHIT_RAY_KINDS; ++kind)
        rays += (double)c->counted.costs[kind].rays;
    return rays > 0.0 ? of / rays : 0.0;
}

double case_visits(const struct bench_case *c)
{
    double visits = 0.0;
    for (int kind = 0; kind < WHIT_RAY_KINDS; ++kind) {
        const whit_cost *cost = &c->counted.costs[kind];
        visits += (double)(cost->inner_nodes + cost->leaves + cost->instances);
    }
    return a_ray(c, visits);
}

double case_triangle_tests(const struct bench_case *c)
{
    double triangles = 0.0;
    for (int kind = 0; kind < WHIT_RAY_KINDS; ++kind)
        triangles += (double)c->counted.costs[kind].triangles;
    return a_ray(c, triangles);
}

double case_depth_mean(const struct bench_case *c)
{
    const whit_cost *primary = &c->counted.costs[WHIT_RAY_PRIMARY];
    return primary->records ? (double)primary->depth_sum / (double)primary->records : NAN;
}

json_t *case_document(const struct bench_case *c)
{
    json_t *object = document_object();
    document_text(object, "case", c->label);
    document_text(object, "scene", c->scene);
    document_count(object, "triangles", c->loaded.info.triangle_count);
    document_put(object, "build_ms", table_times(&c->build));
    if (c->accel_info.node_count) {
        document_number(object, "sah_cost", c->accel_info.sah_cost);
        document_count(object, "nodes", c->accel_info.node_count);
        document_count(object, "references", c->accel_info.reference_count);
        document_count(object, "depth", c->accel_info.depth);
    }
    if (c->frame.count == 0)
        return object;
    document_put(object, "frame_ms", table_times(&c->frame));
    document_number(object, "fps", case_fps(c));
    document_count(object, "width", c->width);
    document_count(object, "height", c->height);
    document_number(object, "visits_per_ray", case_visits(c));
    document_number(object, "triangle_tests_per_ray", case_triangle_tests(c));
    if (!isnan(case_depth_mean(c)))
        document_number(object, "depth_mean", case_depth_mean(c));
    document_count(object, "depth_max", c->counted.costs[WHIT_RAY_PRIMARY].depth);
    if (c->report_fps > 0.0)
        document_number(object, "report_fps", c->report_fps);
    return object;
}

/* ---- Runs ---- */

struct turns {
    struct bench *bench;
    struct bench_case *cases;
};

whit_result case_build(struct bench_case *c)
{
    whit_accel_destroy(c->accel);
    c->accel = NULL;
    whit_result result = whit_accel_create(c->loaded.scene, &c->accel_params, &c->accel);
    if (result == WHIT_OK)
        whit_accel_get_info(c->accel, &c->accel_info);
    return result;
}

static whit_result build_once(void *user, uint32_t index, uint32_t run)
{
    const struct turns *turns = user;
    struct bench_case *c = &turns->cases[index];
    whit_result result = case_build(c);
    (void)run;
    if (result == WHIT_OK)
        sample_add(&c->build, c->accel_info.build_ms);
    return result == WHIT_OK ? bench_step(turns->bench) : result;
}

/* The first run is a warm-up. */
static whit_result render_once(void *user, uint32_t index, uint32_t run)
{
    const struct turns *turns = user;
    struct bench_case *c = &turns->cases[index];
    whit_result result = whit_renderer_render(c->renderer);
    if (result != WHIT_OK)
        return result;
    whit_renderer_get_stats(c->renderer, &c->counted);
    if (run > 0)
        sample_add(&c->frame, c->counted.render_ms);
    return bench_step(turns->bench);
}

static whit_result create_renderers(struct bench *bench, struct bench_case *cases, uint32_t count,
                                    bool counting)
{
    whit_result result = WHIT_OK;
    for (uint32_t i = 0; result == WHIT_OK && i < count; ++i) {
        struct bench_case *c = &cases[i];
        c->width = bench->ask.width / (c->shrink ? c->shrink : 1);
        c->height = bench->ask.height / (c->shrink ? c->shrink : 1);
        const whit_renderer_params params = {
            .width = c->width,
            .height = c->height,
            .traversal = c->traversal,
            .shadows = c->shadows,
            .count = counting,
            .cancel = &cli_cancel,
        };
        whit_renderer_destroy(c->renderer);
        c->renderer = NULL;
        result = whit_renderer_create(bench->device, c->accel, &params, &c->renderer);
    }
    return result;
}

whit_result cases_load(const struct bench *bench, struct bench_case *cases, uint32_t count)
{
    char path[BENCH_PATH];
    for (uint32_t i = 0; i < count; ++i) {
        if (i > 0 && strcmp(cases[i].scene, cases[i - 1].scene) == 0) {
            cases[i].loaded = cases[i - 1].loaded;
            continue;
        }
        whit_result result = bench_find(bench, cases[i].scene, path);
        if (result == WHIT_OK)
            result = bench_load(path, &cases[i].loaded);
        if (result != WHIT_OK)
            return result;
    }
    return WHIT_OK;
}

uint32_t cases_steps(const struct bench *bench)
{
    return bench->ask.runs + (bench->ask.quick ? 1 : 2);
}

whit_result cases_build(struct bench *bench, struct bench_case *cases, uint32_t count)
{
    struct turns turns = {.bench = bench, .cases = cases};
    return sample_in_turns(count, bench->ask.runs, build_once, &turns);
}

whit_result cases_draw(struct bench *bench, struct bench_case *cases, uint32_t count)
{
    struct turns turns = {.bench = bench, .cases = cases};
    bool quick = bench->ask.quick;
    whit_result result = create_renderers(bench, cases, count, quick);
    if (result == WHIT_OK)
        result = sample_in_turns(count, bench->ask.runs + 1, render_once, &turns);
    if (result == WHIT_OK && !quick)
        result = create_renderers(bench, cases, count, true);
    if (result == WHIT_OK && !quick)
        result = sample_in_turns(count, 1, render_once, &turns);
    return result;
}

void cases_finish(struct bench_case *cases, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i) {
        whit_renderer_destroy(cases[i].renderer);
        whit_accel_destroy(cases[i].accel);
    }
    for (uint32_t i = 0; i < count; ++i)
        if (i + 1 == count || cases[i].loaded.scene != cases[i + 1].loaded.scene)
            bench_unload(&cases[i].loaded);
}

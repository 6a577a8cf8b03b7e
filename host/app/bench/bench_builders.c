/* Builders against each other: sections that the report has not. */
#include <math.h>
#include <string.h>

#include "app/bench/bench_section.h"

static void rows_of_builders(struct section *section, const struct bench_case *cases,
                             uint32_t count)
{
    static const char *const heads[] = {"build",      "ms to build",  "references",
                                        "SAH cost",   "visits a ray", "triangle tests a ray",
                                        "ms a frame", "fps",          NULL};
    struct table *table = &section->table;
    table_begin(table, heads);
    for (uint32_t i = 0; i < count; ++i) {
        const struct bench_case *c = &cases[i];
        table_row(table);
        table_cell(table, "%s", c->label);
        table_ms(table, &c->build);
        table_cell(table, "%u", c->accel_info.reference_count);
        table_cell(table, "%.2f", c->accel_info.sah_cost);
        table_cell(table, "%.2f", bench_visits(c));
        table_cell(table, "%.2f", bench_triangle_tests(c));
        table_ms(table, &c->frame);
        table_cell(table, "%.1f", bench_fps(c));
        section_keep(section, c, "", 0.0);
    }
}

/* Loads, measures all there is, makes the table. */
static whit_result measure_builders(struct section *section, const char *scene_name,
                                    struct bench_scene *scene, struct bench_case *cases,
                                    uint32_t count)
{
    struct bench *bench = section->bench;
    whit_result result = bench_load(bench, scene_name, scene);
    for (uint32_t i = 0; i < count; ++i)
        cases[i].scene = scene;
    if (result == WHIT_OK)
        result = bench_build(bench, cases, count, bench->runs);
    if (result == WHIT_OK)
        result = bench_render(bench, cases, count, bench->runs);
    if (result == WHIT_OK)
        result = bench_count(bench, cases, count);
    if (result == WHIT_OK)
        rows_of_builders(section, cases, count);
    return result;
}

/* A quick run keeps a few of the cases. */
static uint32_t choose_cases(const struct bench *bench, struct bench_case *cases, uint32_t count,
                             const char *const *quick)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; ++i) {
        bool wanted = !bench->quick;
        for (uint32_t k = 0; quick[k]; ++k)
            wanted = wanted || strcmp(quick[k], cases[i].label) == 0;
        if (wanted)
            cases[kept++] = cases[i];
    }
    return kept;
}

static const struct bench_case *find_case(const struct bench_case *cases, uint32_t count,
                                          const char *label)
{
    uint32_t i = 0;
    while (i + 1 < count && strcmp(cases[i].label, label) != 0)
        ++i;
    return &cases[i];
}

/* The fewest bins that cost at most 2 % more than the best. */
static void judge_bins(struct section *section, const struct bench_case *cases, uint32_t bin_cases)
{
    uint32_t best = 0, enough = 0;
    for (uint32_t i = 0; i < bin_cases; ++i) {
        if (cases[i].accel_info.sah_cost < cases[best].accel_info.sah_cost)
            best = i;
    }
    double best_cost = cases[best].accel_info.sah_cost;
    while (cases[enough].accel_info.sah_cost > 1.02 * best_cost)
        ++enough;
    const struct bench_case *sweep = &cases[bin_cases];
    char fewest[64] = "";
    if (enough != best)
        snprintf(fewest, sizeof fewest, "; %s is within 2 %% of it", cases[enough].label);
    section_say(section, "Least SAH cost among bins: %s (%.2f)%s. sweep is at %.2f, %.1f %% %s.",
                cases[best].label, best_cost, fewest, sweep->accel_info.sah_cost,
                100.0 * fabs(sweep->accel_info.sah_cost / best_cost - 1.0),
                sweep->accel_info.sah_cost <= best_cost ? "below" : "above");
}

whit_result bench_numbers_of_bins(struct bench *bench)
{
    struct bench_scene scene = {0};
    struct section section;
    struct bench_case cases[] = {
        {.label = "binned:2", .accel_params.bins = 2},
        {.label = "binned:4", .accel_params.bins = 4},
        {.label = "binned:7", .accel_params.bins = 7},
        {.label = "binned:8", .accel_params.bins = 8},
        {.label = "binned:16", .accel_params.bins = 16},
        {.label = "binned:32", .accel_params.bins = 32},
        {.label = "binned:64", .accel_params.bins = 64},
        {.label = "sweep", .accel_params.build = WHIT_BUILD_SWEEP},
    };
    static const char *const quick[] = {"binned:2", "binned:7", "sweep", NULL};
    uint32_t count = choose_cases(bench, cases, CASES(cases), quick);
    section_begin(&section, bench, "bins", count * (2 * bench->runs + 2));
    whit_result result = measure_builders(&section, "54k", &scene, cases, count);
    if (result == WHIT_OK)
        judge_bins(&section, cases, count - 1);
    bench_case_finish(cases, count);
    bench_unload(&scene);
    return section_end(&section, "54k: how many bins", result);
}

static void judge_spatial(struct section *section, const struct bench_case *sweep,
                          const struct bench_case *spatial)
{
    double references = spatial->accel_info.reference_count;
    int faster = bench_compare(&sweep->frame, &spatial->frame);
    section_say(
        section,
        "Spatial splits make %.0f %% more references than there are triangles; rays open %.0f %% "
        "%s nodes than in the tree of sweep, and the frame %s: %.2f times its frames.",
        100.0 * (references / (double)spatial->scene->info.mesh_triangle_count - 1.0),
        100.0 * fabs(bench_visits(spatial) / bench_visits(sweep) - 1.0),
        bench_visits(spatial) < bench_visits(sweep) ? "fewer" : "more",
        faster > 0   ? "is faster"
        : faster < 0 ? "is slower"
                     : "takes as long, within the spread",
        bench_fps(spatial) / bench_fps(sweep));
}

whit_result bench_spatial_splits(struct bench *bench, const char *scene_name, const char *title)
{
    struct bench_scene scene = {0};
    struct section section;
    struct bench_case cases[] = {
        {.label = "binned:7", .accel_params.bins = 7},
        {.label = "binned"},
        {.label = "binned+opt", .accel_params.optimize = true},
        {.label = "sweep", .accel_params.build = WHIT_BUILD_SWEEP},
        {.label = "sweep+opt", .accel_params = {.build = WHIT_BUILD_SWEEP, .optimize = true}},
        {.label = "spatial", .accel_params.build = WHIT_BUILD_SPATIAL},
        {.label = "spatial+opt", .accel_params = {.build = WHIT_BUILD_SPATIAL, .optimize = true}},
    };
    static const char *const quick[] = {"sweep", "spatial", NULL};
    uint32_t count = choose_cases(bench, cases, CASES(cases), quick);
    section_begin(&section, bench, scene_name, count * (2 * bench->runs + 2));
    whit_result result = measure_builders(&section, scene_name, &scene, cases, count);
    if (result == WHIT_OK)
        judge_spatial(&section, find_case(cases, count, "sweep"),
                      find_case(cases, count, "spatial"));
    bench_case_finish(cases, count);
    bench_unload(&scene);
    return section_end(&section, title, result);
}

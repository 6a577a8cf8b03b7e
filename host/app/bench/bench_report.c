/* The tables of the report that whit comes from, on whit's scenes of the same sizes. */
#include "app/bench/bench_section.h"
#include "settings/values.h"

/* What the report says; it names no machine like this one. */
static const double report_cube_fps[2] = {120.0, 40.0}; /* with a tree, without */
static const double report_build_s[2] = {0.328, 249.8}; /* 7 bins, every position */
static const double report_build_fps[2] = {2.7, 4.7};
static const double report_order_fps[3] = {22.0, 33.0, 28.0}; /* none, by distance, by sign */

/* ---- Trees and none ---- */

/* Pixels on a side of the full picture for one of the small picture. */
enum { SHRINK = 20, SHRINK_QUICK = 4 };

static double estimated_frame_ms(const struct bench *bench, const struct bench_case *small)
{
    double pixels = (double)bench->width * bench->height;
    return sample_of(&small->frame).median * pixels / ((double)small->width * small->height);
}

static void row_of_trees(struct section *section, const struct bench_case *c, const char *report,
                         double estimate_ms)
{
    table_row(&section->table);
    table_cell(&section->table, "%s, %s", c->scene->name, c->label);
    table_cell(&section->table, "%s", report);
    if (estimate_ms > 0.0) {
        table_cell(&section->table, "%.3g (estimated)", 1e3 / estimate_ms);
        table_cell(&section->table, "%.0f (estimated)", estimate_ms);
        return;
    }
    table_cell(&section->table, "%.1f", bench_fps(c));
    table_ms(&section->table, &c->frame);
}

static void judge_trees(struct section *section, const struct bench_case *cases)
{
    double report = report_cube_fps[0] / report_cube_fps[1];
    double ratio = bench_fps(&cases[0]) / bench_fps(&cases[1]);
    int slower = bench_compare(&cases[1].frame, &cases[0].frame);
    section_say(
        section,
        "Cube: %s; with a tree it makes %.2f times as many frames as without (report: %.1f).",
        slower > 0   ? "the report's claim that the tree pays holds here"
        : slower < 0 ? "the report's claim that the tree pays does NOT hold here"
                     : "the report's claim that the tree pays does NOT hold here, as there is no "
                       "difference beyond the spread",
        ratio, report);
    double estimate_ms = estimated_frame_ms(section->bench, &cases[3]);
    section_say(
        section,
        "34k without a tree is estimated, not measured: the same view in %u x %u pixels took "
        "%.0f ms, times %.0f for the pixels of the full picture. That is %.0f times the frame with "
        "a tree; the report's never finished. Both are without shadows, whose rays by all four "
        "lights "
        "test more than one dispatch of a driver grants.",
        cases[3].width, cases[3].height, sample_of(&cases[3].frame).median,
        (double)section->bench->width * section->bench->height /
            ((double)cases[3].width * cases[3].height),
        estimate_ms / sample_of(&cases[2].frame).median);
}

static whit_result trees_on_and_off(struct bench *bench)
{
    struct bench_scene cube = {0}, many = {0};
    struct section section;
    uint32_t shrink = bench->quick ? SHRINK_QUICK : SHRINK;
    const whit_accel_params with = {.bins = 7}, without = {.build = WHIT_BUILD_NONE};
    struct bench_case cases[] = {
        {.label = "tree", .scene = &cube, .accel_params = with},
        {.label = "no tree", .scene = &cube, .accel_params = without},
        {.label = "tree", .scene = &many, .accel_params = with, .effects = "-shadows"},
        {.label = "no tree",
         .scene = &many,
         .accel_params = without,
         .effects = "-shadows",
         .width = bench->width / shrink,
         .height = bench->height / shrink},
    };
    const uint32_t few = bench->runs < 3 ? bench->runs : 3;
    section_begin(&section, bench, "trees", CASES(cases) + 2 + 2 * bench->runs + 2 * (1 + few));
    whit_result result = bench_load(bench, "cube", &cube);
    if (result == WHIT_OK)
        result = bench_load(bench, "34k", &many);
    if (result == WHIT_OK)
        result = bench_build(bench, cases, CASES(cases), 1);
    if (result == WHIT_OK)
        result = bench_render(bench, cases, 2, bench->runs);
    if (result == WHIT_OK)
        result = bench_render(bench, cases + 2, 2, few);
    if (result == WHIT_OK) {
        static const char *const heads[] = {"scene", "report, fps", "whit, fps", "ms a frame",
                                            NULL};
        table_begin(&section.table, heads);
        row_of_trees(&section, &cases[0], "120", 0.0);
        row_of_trees(&section, &cases[1], "40", 0.0);
        row_of_trees(&section, &cases[2], "-", 0.0);
        row_of_trees(&section, &cases[3], "never done", estimated_frame_ms(bench, &cases[3]));
        for (uint32_t i = 0; i < CASES(cases); ++i)
            section_keep(&section, &cases[i], "report_fps", i < 2 ? report_cube_fps[i] : 0.0);
        judge_trees(&section, cases);
    }
    bench_case_finish(cases, CASES(cases));
    bench_unload(&cube);
    bench_unload(&many);
    return section_end(&section, "Trees on and off", result);
}

/* ---- Bins or every position ---- */

static void judge_builds(struct section *section, const struct bench_case *cases)
{
    const struct bench_case *binned = &cases[0], *sweep = &cases[1];
    double binned_ms = sample_of(&binned->build).median, sweep_ms = sample_of(&sweep->build).median;
    section_say(
        section,
        "Every position, sorted once, takes %.1f times as long as 7 bins; summed up anew for each "
        "position it took the report %.0f times as long.",
        sweep_ms / binned_ms, report_build_s[1] / report_build_s[0]);
    int faster = bench_compare(&binned->frame, &sweep->frame);
    section_say(
        section,
        "The report's claim that every position makes the faster tree %s: %.2f times the frames "
        "of 7 bins (report: %.2f).",
        faster > 0   ? "holds here"
        : faster < 0 ? "does NOT hold here"
                     : "does NOT hold here, as there is no difference beyond the spread",
        bench_fps(sweep) / bench_fps(binned), report_build_fps[1] / report_build_fps[0]);
}

static void rows_of_builds(struct section *section, const struct bench_case *cases)
{
    static const char *const heads[] = {"build",       "report, s",    "whit, ms",
                                        "report, fps", "whit, fps",    "ms a frame",
                                        "SAH cost",    "visits a ray", NULL};
    struct table *table = &section->table;
    table_begin(table, heads);
    for (int i = 0; i < 2; ++i) {
        table_row(table);
        table_cell(table, "%s", cases[i].label);
        table_cell(table, "%g", report_build_s[i]);
        table_ms(table, &cases[i].build);
        table_cell(table, "%.1f", report_build_fps[i]);
        table_cell(table, "%.1f", bench_fps(&cases[i]));
        table_ms(table, &cases[i].frame);
        table_cell(table, "%.2f", cases[i].accel_info.sah_cost);
        table_cell(table, "%.2f", bench_visits(&cases[i]));
    }
}

static whit_result bins_or_all(struct bench *bench)
{
    struct bench_scene scene = {0};
    struct section section;
    struct bench_case cases[] = {
        {.label = "binned:7", .scene = &scene, .accel_params.bins = 7},
        {.label = "sweep", .scene = &scene, .accel_params.build = WHIT_BUILD_SWEEP},
    };
    section_begin(&section, bench, "builds", 4 * bench->runs + 4);
    whit_result result = bench_load(bench, "54k", &scene);
    if (result == WHIT_OK)
        result = bench_build(bench, cases, CASES(cases), bench->runs);
    if (result == WHIT_OK)
        result = bench_render(bench, cases, CASES(cases), bench->runs);
    if (result == WHIT_OK)
        result = bench_count(bench, cases, CASES(cases));
    if (result == WHIT_OK) {
        rows_of_builds(&section, cases);
        section_keep(&section, &cases[0], "report_fps", report_build_fps[0]);
        section_keep(&section, &cases[1], "report_fps", report_build_fps[1]);
        judge_builds(&section, cases);
    }
    bench_case_finish(cases, CASES(cases));
    bench_unload(&scene);
    return section_end(&section, "54k: bins, or every position", result);
}

/* ---- Orders of traversal ---- */

static void rows_of_orders(struct section *section, const struct bench_case *cases, uint32_t count)
{
    static const char *const heads[] = {"order",       "report, fps",  "whit, fps",
                                        "ms a frame",  "visits a ray", "triangle tests a ray",
                                        "depth: mean", "most",         NULL};
    struct table *table = &section->table;
    table_begin(table, heads);
    for (uint32_t i = 0; i < count; ++i) {
        const struct bench_case *c = &cases[i];
        const whit_cost *primary = &c->counted.costs[WHIT_RAY_PRIMARY];
        double records = primary->records ? (double)primary->records : 1.0;
        table_row(table);
        table_cell(table, "%s", c->label);
        table_cell(table, "%.0f", report_order_fps[i]);
        table_cell(table, "%.1f", bench_fps(c));
        table_ms(table, &c->frame);
        table_cell(table, "%.2f", bench_visits(c));
        table_cell(table, "%.2f", bench_triangle_tests(c));
        table_cell(table, "%.2f", (double)primary->depth_sum / records);
        table_cell(table, "%u", primary->depth);
        section_keep(section, c, "report_fps", report_order_fps[i]);
    }
}

static void judge_pair(struct section *section, const struct bench_case *cases, int faster,
                       int slower)
{
    int found = bench_compare(&cases[slower].frame, &cases[faster].frame);
    section_say(section,
                "%s faster than %s, as in the report, %s: %.2f times the frames (report: %.2f).",
                cases[faster].label, cases[slower].label,
                found > 0   ? "holds here"
                : found < 0 ? "does NOT hold here"
                            : "does NOT hold here, as there is no difference beyond the spread",
                bench_fps(&cases[faster]) / bench_fps(&cases[slower]),
                report_order_fps[faster] / report_order_fps[slower]);
}

static void judge_orders(struct section *section, const struct bench_case *cases)
{
    judge_pair(section, cases, 1, 0);
    judge_pair(section, cases, 2, 0);
    judge_pair(section, cases, 1, 2);
    double visits[3];
    for (int i = 0; i < 3; ++i)
        visits[i] = bench_visits(&cases[i]);
    bool max = visits[0] > visits[1] && visits[0] > visits[2];
    section_say(section,
                "Without an order rays open %s: %.2f nodes, %.2f by distance, %.2f by sign.",
                max ? "the most nodes" : "NOT the most nodes", visits[0], visits[1], visits[2]);
    section_say(section,
                "Depth: the deepest level whose boxes a camera ray looked at, its mean over camera "
                "rays and the most.");
}

static whit_result orders(struct bench *bench)
{
    struct bench_scene scene = {0};
    struct section section;
    const whit_accel_params params = {.bins = 7};
    struct bench_case cases[] = {
        {.traversal = WHIT_TRAVERSAL_BASIC},
        {.traversal = WHIT_TRAVERSAL_DISTANCE},
        {.traversal = WHIT_TRAVERSAL_SIGN},
    };
    for (uint32_t i = 0; i < CASES(cases); ++i) {
        cases[i].scene = &scene;
        cases[i].accel_params = params;
        cases[i].label = value_word(values_traversal, (int)cases[i].traversal);
    }
    section_begin(&section, bench, "orders", CASES(cases) * (3 + bench->runs));
    whit_result result = bench_load(bench, "8k", &scene);
    if (result == WHIT_OK)
        result = bench_build(bench, cases, CASES(cases), 1);
    if (result == WHIT_OK)
        result = bench_render(bench, cases, CASES(cases), bench->runs);
    if (result == WHIT_OK)
        result = bench_count(bench, cases, CASES(cases));
    if (result == WHIT_OK) {
        rows_of_orders(&section, cases, CASES(cases));
        judge_orders(&section, cases);
    }
    bench_case_finish(cases, CASES(cases));
    bench_unload(&scene);
    return section_end(&section, "8k: three orders of traversal", result);
}

/* ---- All of it ---- */

static void print_head(const struct bench *bench)
{
    const whit_device_info *device = &bench->device_info;
    printf(
        "## The report's tables\n\n"
        "%s, %s.\n"
        "%u x %u pixels, one sample, no bounces, with shadows; fps is 1000 over the median of\n"
        "renders in ms; ± is half the width of the middle half. %u runs of each case, in turns.\n"
        "The report's figures are from another machine: only ratios compare.\n",
        cli_shown(device->name), cli_shown(device->driver), bench->width, bench->height,
        bench->runs);
    if (bench->quick)
        printf("\n**Quick run: small pictures, few runs and counters on: not for figures to be "
               "quoted.**\n");
    fflush(stdout);
}

whit_result bench_report(struct bench *bench)
{
    print_head(bench);
    whit_result result = trees_on_and_off(bench);
    if (result == WHIT_OK)
        result = bins_or_all(bench);
    if (result == WHIT_OK)
        result = orders(bench);
    if (result == WHIT_OK)
        result = bench_numbers_of_bins(bench);
    if (result == WHIT_OK)
        result =
            bench_spatial_splits(bench, "strands", "strands: spatial splits, long thin triangles");
    if (result == WHIT_OK)
        result = bench_spatial_splits(bench, "atrium", "atrium: spatial splits, an interior");
    return result;
}

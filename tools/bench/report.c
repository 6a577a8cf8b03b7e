/* The tables of the report that whit started from, on whit's scenes of the same sizes. The machine
   of that report is not known. */

#include "bench/cases.h"
#include "bench/table.h"

/* ---- Cells ---- */

/* The frame time of a case, scaled by the number of pixels from the size of its picture to that of
   the bench. */
static double frame_ms(const struct table *table, const struct bench_case *c)
{
    const struct bench_request *ask = &table->bench->ask;
    double pixels = (double)ask->width * ask->height;
    return sample_of(&c->frame).median * pixels / ((double)c->width * c->height);
}

enum cell { CASE, SCENE, REPORT_S, REPORT_FPS, BUILD_MS, FPS, FRAME_MS, SAH, VISITS, TESTS, DEPTH };

static void put_cell(struct table *table, const struct bench_case *c, enum cell cell)
{
    switch (cell) {
    case CASE:
        table_cell(table, "%s", c->label);
        break;
    case SCENE:
        table_cell(table, "%s, %s", c->scene, c->label);
        break;
    case REPORT_S:
        table_cell(table, "%g", c->report_s);
        break;
    case REPORT_FPS:
        table_cell(table, c->report_fps > 0.0 ? "%g" : "-", c->report_fps);
        break;
    case BUILD_MS:
        table_ms(table, &c->build);
        break;
    case FPS:
        table_cell(table, c->shrink ? "%.3g (estimated)" : "%.1f", 1e3 / frame_ms(table, c));
        break;
    case FRAME_MS:
        if (c->shrink)
            table_cell(table, "%.0f (estimated)", frame_ms(table, c));
        else
            table_ms(table, &c->frame);
        break;
    case SAH:
        table_cell(table, "%.2f", c->accel_info.sah_cost);
        break;
    case VISITS:
        table_cell(table, "%.2f", case_visits(c));
        break;
    case TESTS:
        table_cell(table, "%.2f", case_triangle_tests(c));
        break;
    case DEPTH:
        table_cell(table, "%.2f, %u", case_depth_mean(c), c->counted.costs[WHIT_RAY_PRIMARY].depth);
        break;
    }
}

/* ---- Sentences ---- */

/* 1: `b` takes longer; -1: `a` takes longer; 0: sample_compare finds no difference. */
static int compare(const struct bench_case *a, const struct bench_case *b)
{
    const struct sample_runs *x = &a->frame, *y = &b->frame;
    double differences[SAMPLE_RUNS_MAX];
    return sample_compare(y->values, x->values, x->count, differences, NULL);
}

/* Says whether `faster` is faster here than `slower`, as the report says. */
static const char *holds(const struct bench_case *faster, const struct bench_case *slower)
{
    int found = compare(faster, slower);
    return found > 0   ? "holds here"
           : found < 0 ? "does NOT hold here"
                       : "cannot be told here, as there is no difference beyond the spread";
}

static void judge_trees(struct table *table, const struct bench_case *cases)
{
    const struct bench_case *full = &cases[2], *small = &cases[3];
    const struct bench_request *ask = &table->bench->ask;
    table_say(table,
              "Cube: the report's claim that the tree pays %s; with a tree it makes %.2f times as "
              "many frames as without (report: %.1f).",
              holds(&cases[0], &cases[1]), case_fps(&cases[0]) / case_fps(&cases[1]),
              cases[0].report_fps / cases[1].report_fps);
    table_say(table,
              "34k without a tree is estimated, not measured: the same view in %u x %u pixels took "
              "%.0f ms, times %.0f for the pixels of the full picture. That is %.0f times the "
              "frame with a tree; the report's never finished. Both are without shadows, whose "
              "rays by all four lights test more than one dispatch of a driver grants.",
              small->width, small->height, sample_of(&small->frame).median,
              (double)ask->width * ask->height / ((double)small->width * small->height),
              frame_ms(table, small) / sample_of(&full->frame).median);
}

static void judge_builds(struct table *table, const struct bench_case *cases)
{
    const struct bench_case *binned = &cases[0], *sweep = &cases[1];
    table_say(table,
              "Every position, sorted once, takes %.1f times as long as 7 bins; summed up anew for "
              "each position it took the report %.0f times as long.",
              sample_of(&sweep->build).median / sample_of(&binned->build).median,
              sweep->report_s / binned->report_s);
    table_say(table,
              "The report's claim that every position makes the faster tree %s: %.2f times the "
              "frames of 7 bins (report: %.2f).",
              holds(sweep, binned), case_fps(sweep) / case_fps(binned),
              sweep->report_fps / binned->report_fps);
}

static void judge_orders(struct table *table, const struct bench_case *cases)
{
    static const int pairs[][2] = {{1, 0}, {2, 0}, {1, 2}};
    double visits[3];
    for (int i = 0; i < 3; ++i) {
        const struct bench_case *faster = &cases[pairs[i][0]], *slower = &cases[pairs[i][1]];
        visits[i] = case_visits(&cases[i]);
        table_say(table,
                  "%s faster than %s, as in the report, %s: %.2f times the frames (report: %.2f).",
                  faster->label, slower->label, holds(faster, slower),
                  case_fps(faster) / case_fps(slower), faster->report_fps / slower->report_fps);
    }
    bool max = visits[0] > visits[1] && visits[0] > visits[2];
    table_say(table, "Without an order rays open %s: %.2f nodes, %.2f by distance, %.2f by sign.",
              max ? "the most nodes" : "NOT the most nodes", visits[0], visits[1], visits[2]);
    table_say(table,
              "Depth: the deepest level whose boxes a camera ray looked at, its mean over camera "
              "rays and the most.");
}

/* ---- Sections ---- */

#define BUILD(label_, ...) .label = (label_), .accel_params = {__VA_ARGS__}

/* The picture of 34k without a tree has only 32x24 pixels in place of 640x480. */
static struct bench_case trees[] = {
    {BUILD("tree", .bins = 7), .scene = "cube", .report_fps = 120.0},
    {BUILD("no tree", .build = WHIT_BUILD_NONE), .scene = "cube", .report_fps = 40.0},
    {BUILD("tree", .bins = 7), .scene = "34k", .shadows = WHIT_SHADOWS_NONE},
    {BUILD("no tree", .build = WHIT_BUILD_NONE), .scene = "34k", .shadows = WHIT_SHADOWS_NONE,
     .shrink = 20},
};
static struct bench_case builds[] = {
    {BUILD("binned:7", .bins = 7), .scene = "54k", .report_s = 0.328, .report_fps = 2.7},
    {BUILD("sweep", .build = WHIT_BUILD_SWEEP), .scene = "54k", .report_s = 249.8,
     .report_fps = 4.7},
};
static struct bench_case orders[] = {
    {BUILD("basic", .bins = 7), .scene = "8k", .traversal = WHIT_TRAVERSAL_BASIC,
     .report_fps = 22.0},
    {BUILD("distance", .bins = 7), .scene = "8k", .traversal = WHIT_TRAVERSAL_DISTANCE,
     .report_fps = 33.0},
    {BUILD("sign", .bins = 7), .scene = "8k", .traversal = WHIT_TRAVERSAL_SIGN, .report_fps = 28.0},
};
#define CASES(array) .cases = (array), .count = (uint32_t)(sizeof(array) / sizeof((array)[0]))

struct column {
    const char *head;
    enum cell cell;
};
static const struct section {
    const char *name, *title;
    void (*judge)(struct table *table, const struct bench_case *cases);
    struct column columns[TABLE_COLUMNS_MAX];
    struct bench_case *cases;
    uint32_t count;
} sections[] = {
    {"trees",
     "Trees on and off",
     judge_trees,
     {{"scene", SCENE}, {"report, fps", REPORT_FPS}, {"whit, fps", FPS}, {"ms a frame", FRAME_MS}},
     CASES(trees)},
    {"builds",
     "54k: bins, or every position",
     judge_builds,
     {{"build", CASE},
      {"report, s", REPORT_S},
      {"whit, ms", BUILD_MS},
      {"report, fps", REPORT_FPS},
      {"whit, fps", FPS},
      {"ms a frame", FRAME_MS},
      {"SAH cost", SAH},
      {"visits a ray", VISITS}},
     CASES(builds)},
    {"orders",
     "8k: three orders of traversal",
     judge_orders,
     {{"order", CASE},
      {"report, fps", REPORT_FPS},
      {"whit, fps", FPS},
      {"ms a frame", FRAME_MS},
      {"visits a ray", VISITS},
      {"triangle tests a ray", TESTS},
      {"depth: mean, most", DEPTH}},
     CASES(orders)},
};
enum { SECTIONS = sizeof sections / sizeof sections[0] };

static whit_result run_section(struct bench *bench, const struct section *section)
{
    struct table table;
    struct bench_case *cases = section->cases;
    const char *heads[TABLE_COLUMNS_MAX + 1];
    uint32_t count = section->count, columns = 0;
    do
        heads[columns] = section->columns[columns].head;
    while (heads[columns++]);
    table_begin(&table, bench, section->name, heads, false,
                count * (bench->ask.runs + cases_steps(bench)));
    whit_result result = cases_load(bench, cases, count);
    if (result == WHIT_OK)
        result = cases_build(bench, cases, count);
    if (result == WHIT_OK)
        result = cases_draw(bench, cases, count);
    for (uint32_t i = 0; result == WHIT_OK && i < count; ++i) {
        table_row(&table);
        for (uint32_t k = 0; heads[k]; ++k)
            put_cell(&table, &cases[i], section->columns[k].cell);
        table_keep(&table, case_document(&cases[i]));
    }
    if (result == WHIT_OK)
        section->judge(&table, cases);
    table_say(&table, "The report is that on the interactive Whitted ray tracer from which whit "
                      "began. Its figures "
                      "are from another machine: only ratios compare.");
    cases_finish(cases, count);
    return table_end(&table, section->title, result);
}

whit_result bench_report(struct bench *bench)
{
    trees[3].shrink = bench->ask.quick ? 4 : trees[3].shrink;
    whit_result result = WHIT_OK;
    for (int i = 0; result == WHIT_OK && i < SECTIONS; ++i)
        result = run_section(bench, &sections[i]);
    return result;
}

/* `whit bench frame`: whole pictures beside POV-Ray, another whit, the levels, and their own rays.
 */
#include "frame.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char BAILOUT[] = "0.0009765625", POV_BAILOUT[] = "0.0005";

/* What pictures must reach, beside one peer each; POV-Ray's have the depth of tests/peers/pov. */
static const struct frame_goal {
    const char *name;
    enum frame_side beside;
    uint32_t depth;
    struct goal goal;
} goals[] = {
    {"glass", FRAME_POV, 10, {0.50, 0.25, false}},
    {"wine", FRAME_POV, 2, {0.50, 0.25, false}},
    {"flake", FRAME_POV, 10, {0.50, 0.25, false}},
    {"hollow", FRAME_POV, 10, {0.58, 0.30, false}},
    {"mesh", FRAME_POV, 10, {0.19, 0.08, false}},
    {"whitted", FRAME_AGAINST, 8, {0.32, 0.15, false}},
    {"default", FRAME_AGAINST, 8, {0.48, 0.25, false}},
    {"34k", FRAME_AGAINST, 8, {0.60, 0.35, false}},
    {"room", FRAME_AGAINST, 8, {0.70, 0.40, false}},
};
enum { GOALS = sizeof goals / sizeof goals[0], POV_GOALS = 5 };
static const struct goal own_rays_goal = {1.9, 1.0, false}, level_goal = {1.10, 1.05, false},
                         memory_goal = {110.0, 60.0, false};
static const char own_rays_of[] = "34k", viewer[] = "viewer";

static const struct frame_goal *goal_of(const char *name)
{
    for (size_t i = 0; i < GOALS; ++i) {
        if (strcmp(goals[i].name, name) == 0)
            return &goals[i];
    }
    return NULL;
}

static bool is_pov(const char *name)
{
    const struct frame_goal *goal = goal_of(name);
    return goal && goal->beside == FRAME_POV;
}

/* ---- Rows ---- */

static void put_ms(struct figures *figures, const struct sample_runs *times)
{
    struct table *table = &figures->section.table;
    if (times)
        table_ms(table, times);
    else
        table_cell(table, "-");
}

/* `what` of the frame beside `beside`, as the share of time of the former side in that of the
   latter. */
static void put_ratio(struct figures *figures, const struct frame *frame, const char *what,
                      enum frame_side side, const char *beside, enum frame_side other,
                      struct goal goal)
{
    struct figure figure = {.unit = "", .goal = goal};
    struct sample_runs ratio = sample_ratio(&frame->ms[side], &frame->ms[other]);
    json_t *row = document_object();
    snprintf(figure.name, sizeof figure.name, "%s%s : %.16s", frame->name, what, beside);
    figure.value = sample_of(&ratio).median;
    figure.spread = sample_of(&ratio).spread;
    document_text(row, "picture", frame->name);
    document_text(row, "level", what[0] ? what + 2 : "watertight");
    document_text(row, "beside", beside);
    document_put(row, "ms", figures_times(&frame->ms[side]));
    document_put(row, "beside_ms", figures_times(&frame->ms[other]));
    document_put(row, "reference_ms", figures_times(&frame->ms[FRAME_REFERENCE]));
    table_row(&figures->section.table);
    table_cell(&figures->section.table, "%s%s", frame->name, what);
    table_cell(&figures->section.table, "%.40s", cli_shown(beside));
    put_ms(figures, &frame->ms[side]);
    put_ms(figures, &frame->ms[other]);
    put_ms(figures, side == FRAME_WHIT ? &frame->ms[FRAME_REFERENCE] : NULL);
    figures_row(figures, &figure, row);
}

static void put_value(struct figures *figures, const char *name, double value, const char *unit,
                      struct goal goal)
{
    struct figure figure = {.unit = unit, .value = value, .goal = goal};
    snprintf(figure.name, sizeof figure.name, "%s", name);
    table_row(&figures->section.table);
    table_cell(&figures->section.table, "%s", name);
    for (int i = 0; i < 4; ++i)
        table_cell(&figures->section.table, "-");
    json_t *row = document_object();
    document_text(row, "picture", name);
    figures_row(figures, &figure, row);
}

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

static void put_rows(struct figures *figures, const struct frame *frame)
{
    const struct frame_goal *goal = goal_of(frame->name);
    struct goal none = {0};
    if (frame->ms[FRAME_POV].count)
        put_ratio(figures, frame, "", FRAME_WHIT, "POV-Ray", FRAME_POV, goal->goal);
    if (frame->ms[FRAME_AGAINST].count)
        put_ratio(figures, frame, "", FRAME_WHIT, base_name(figures->section.bench->against),
                  FRAME_AGAINST, goal ? goal->goal : none);
    if (frame->ms[FRAME_EMBREE].count)
        put_ratio(figures, frame, "", FRAME_WHIT, "Embree, its rays", FRAME_EMBREE, own_rays_goal);
    if (frame->ms[FRAME_EXACT].count) {
        put_ratio(figures, frame, ", exact", FRAME_EXACT, "watertight", FRAME_WHIT, level_goal);
        put_ratio(figures, frame, ", watertight", FRAME_WHIT, "fast", FRAME_FAST, level_goal);
    }
}

/* ---- One picture ---- */

static void choose_sides(struct frame *frame, const struct peers *peers)
{
    bool pov = is_pov(frame->name);
    const bool takes_part[FRAME_SIDES] = {
        [FRAME_WHIT] = true,
        [FRAME_FAST] = !pov,
        [FRAME_EXACT] = !pov,
        [FRAME_AGAINST] = !pov && frame->bench->against,
        [FRAME_POV] = pov,
        [FRAME_REFERENCE] = true,
        [FRAME_EMBREE] = peers->has_embree && strcmp(frame->name, own_rays_of) == 0,
    };
    for (int side = 0; side < FRAME_SIDES; ++side) {
        if (takes_part[side])
            frame->sides[frame->side_count++] = (enum frame_side)side;
    }
}

static whit_result write_pov_scene(const struct frame *frame, const struct peers *peers)
{
    char width[16], height[16], depth[16];
    snprintf(width, sizeof width, "%u", frame->width);
    snprintf(height, sizeof height, "%u", frame->height);
    snprintf(depth, sizeof depth, "%u", frame->depth);
    const char *const arguments[] = {"sh",  peers->pov_scenes, frame->name, "colors", width, height,
                                     depth, peers->folder,     NULL};
    const struct bench_child child = {.program = "sh", .arguments = arguments};
    return bench_child_run(&child, NULL);
}

/* `path`: of its scene; NULL: one of POV-Ray's. */
static whit_result run_frame(const struct peers *peers, const char *name, const char *path)
{
    struct bench *bench = peers->figures->section.bench;
    const struct frame_goal *goal = goal_of(name);
    struct frame frame = {.bench = bench,
                          .folder = peers->folder,
                          .bailout = path ? BAILOUT : POV_BAILOUT,
                          .depth = goal ? goal->depth : 8,
                          .width = path ? bench->width : bench->width * 3 / 4,
                          .height = bench->height,
                          .small_width = 32,
                          .small_height = path ? 18 : 24,
                          .is_cpu = strcmp(bench->device_info.kind, "cpu") == 0,
                          .peer = {.socket = -1}};
    whit_result result = WHIT_OK;
    double megabytes = 0.0;
    if (bench->quick)
        frame.small_width = frame.small_height = 0;
    snprintf(frame.name, sizeof frame.name, "%s", name);
    if (path)
        snprintf(frame.path, sizeof frame.path, "%s", path);
    else
        snprintf(frame.path, sizeof frame.path, "%s/%s.json", peers->folder, name);
    if (!path)
        result = write_pov_scene(&frame, peers);
    choose_sides(&frame, peers);
    if (result == WHIT_OK)
        result = frame_prepare(&frame);
    if (result == WHIT_OK && path)
        result = frame_memory(&frame, &megabytes);
    if (result == WHIT_OK && peers->has_embree && strcmp(name, own_rays_of) == 0) {
        result = frame_prepare_rays(&frame);
        section_say(&peers->figures->section, "Beside Embree %s.", frame.peer.version);
    }
    if (result == WHIT_OK)
        result = frame_run(&frame);
    if (result == WHIT_OK)
        put_rows(peers->figures, &frame);
    if (result == WHIT_OK && path) {
        char row[TABLE_CELL];
        snprintf(row, sizeof row, "%s, device memory", name);
        put_value(peers->figures, row, megabytes, "MB", memory_goal);
    }
    bench_step(bench);
    frame_finish(&frame);
    return result;
}

/* ---- The viewer ---- */

#ifdef WHIT_VIEWER
static whit_result view_one(const struct peers *peers, const char *scene, uint32_t width,
                            uint32_t height, struct bench_view_case *c)
{
    struct bench bench = *peers->figures->section.bench;
    *c = (struct bench_view_case){.scene = scene, .label = "full"};
    bench.width = bench.quick ? width / 10 : width;
    bench.height = bench.quick ? height / 10 : height;
    return bench_view_measure(&bench, c, peers->folder);
}

static whit_result run_viewer(const struct peers *peers)
{
    static const struct goal whole_goal = {8.0, 17.0, true}, size_goal = {6.0, 4.0, false},
                             moving_goal = {30.0, 30.0, true};
    struct bench_view_case still, moving = {0};
    whit_result result = view_one(peers, "34k", 640, 480, &still);
    if (result == WHIT_OK) {
        double ms = bench_view_number(still.whole, "whole_ms", "median");
        put_value(peers->figures, "viewer, 34k, whole pictures", ms > 0.0 ? 1e3 / ms : 0.0,
                  "a second", whole_goal);
        result = view_one(peers, "default", 1280, 720, &moving);
    }
    if (result == WHIT_OK) {
        double ms = bench_view_number(moving.moving, "gap_ms", "median");
        put_value(peers->figures, "viewer, default moving, size 1/N",
                  bench_view_number(moving.moving, "divisor", "median"), "", size_goal);
        put_value(peers->figures, "viewer, default moving", ms > 0.0 ? 1e3 / ms : 0.0, "a second",
                  moving_goal);
    }
    bench_step(peers->figures->section.bench);
    bench_view_finish(&still);
    bench_view_finish(&moving);
    return result;
}
#else
static whit_result run_viewer(const struct peers *peers)
{
    (void)peers;
    return WHIT_OK;
}
#endif

/* Why there is no viewer to measure; NULL: there is. */
static const char *why_no_viewer(void)
{
#ifdef WHIT_VIEWER
    bool shown = getenv("DISPLAY") || getenv("WAYLAND_DISPLAY");
    return shown ? NULL : "no display (DISPLAY and WAYLAND_DISPLAY are not set)";
#else
    return "this whit was built without it (WHIT_VIEWER)";
#endif
}

/* ---- The bench ---- */

static void say_how(struct figures *figures)
{
    const struct bench *bench = figures->section.bench;
    const whit_device_info *device = &bench->device_info;
    section_say(&figures->section,
                "%s, %s; %u x %u pixels, POV-Ray's %u x %u; runs in turns: %u; medians, with half "
                "the width of the middle half.",
                cli_shown(device->name), cli_shown(device->driver), bench->width, bench->height,
                bench->width * 3 / 4, bench->height, bench->runs);
    bool is_cpu = strcmp(device->kind, "cpu") == 0;
    section_say(
        &figures->section,
        "ms: %s a process of its own, less that of a picture 32 wide, caches filled; figure: "
        "times the time of what is beside it. Reference: the same picture in double.",
        is_cpu ? "processor time of all threads of"
               : "time by the clock, as this device is no CPU, of");
    section_say(&figures->section,
                "Depth 8, bailout 1/1024, 16 points of an area light, one sample; beside POV-Ray "
                "depth 10 (wine: 2) and bailout 0.0005.");
    if (bench->quick)
        section_say(&figures->section, "Quick run: small pictures, not for figures to be quoted.");
}

/* One of POV-Ray's, a scene of whit's by its name, or a file. Sets `path`, "" for the former. */
static whit_result find_scene(const struct bench *bench, const char *word, char name[40],
                              char path[BENCH_PATH])
{
    const char *base = base_name(word), *dot = strrchr(base, '.');
    snprintf(name, 40, "%.*s", (int)(dot ? dot - base : (long)strlen(base)), base);
    path[0] = 0;
    if (is_pov(word) || strcmp(word, viewer) == 0)
        return WHIT_OK;
    char *whole = realpath(word, NULL);
    if (!whole && !strchr(word, '/') && !dot) {
        char found[BENCH_PATH];
        if (bench_find(bench, word, found, sizeof found) != WHIT_OK)
            return WHIT_ERROR_INPUT;
        whole = realpath(found, NULL);
    }
    if (!whole) {
        cli_error("%s: is not there", cli_shown(word));
        return WHIT_ERROR_INPUT;
    }
    snprintf(path, BENCH_PATH, "%s", whole);
    free(whole);
    return WHIT_OK;
}

static whit_result run_word(const struct peers *peers, const char *word, bool only_look)
{
    char name[40], path[BENCH_PATH];
    whit_result result = find_scene(peers->figures->section.bench, word, name, path);
    if (result != WHIT_OK || only_look)
        return result;
    if (strcmp(word, viewer) == 0) {
        const char *why = why_no_viewer();
        if (!why && (result = run_viewer(peers)) == WHIT_ERROR_NO_DEVICE)
            why = "it finds no display that it can use";
        if (why)
            figures_leave_out(peers->figures, viewer, why);
        return why ? WHIT_OK : result;
    }
    if (!path[0] && !peers->has_pov)
        return WHIT_OK; /* said once for all of them */
    return run_frame(peers, name, path[0] ? path : NULL);
}

whit_result bench_frame(struct bench *bench)
{
    static const char *const heads[] = {"picture",    "beside",        "whit, ms",
                                        "beside, ms", "reference, ms", NULL};
    static struct figures figures;
    struct peers peers = {.figures = &figures};
    const char *all[GOALS + 1];
    for (size_t i = 0; i < GOALS; ++i)
        all[i] = goals[i].name;
    all[GOALS] = viewer;
    const char *const *words = bench->name_count ? bench->names : all;
    uint32_t count = bench->name_count ? bench->name_count : GOALS + 1;
    whit_result result = bench_scratch_make(peers.folder);
    if (result != WHIT_OK)
        return result;
    cli_keep_what_is_done(BENCH_GRACE_MS);
    figures_begin(&figures, bench, "frame", heads, count);
    say_how(&figures);
    for (uint32_t i = 0; result == WHIT_OK && i < count; ++i) {
        result = run_word(&peers, words[i], true);
        peers.wants_pov = peers.wants_pov || is_pov(words[i]);
    }
    if (result == WHIT_OK)
        result = frame_find_peers(&peers);
    for (uint32_t i = 0; result == WHIT_OK && i < count; ++i)
        result = run_word(&peers, words[i], false);
    bench_scratch_remove(peers.folder);
    return figures_end(&figures, "Whole pictures", result);
}

/* `whit bench frame`: compares whole pictures with POV-Ray, another version of whit, other levels
   of numerics, and the tracing of only their rays by Embree. */
#include "bench/frame_peers.h"

#include <string.h>

#include "base/path.h"
#include "bench/frame_rays.h"
#include "bench/frame_sides.h"
#include "bench/process.h"

static const char BAILOUT[] = "0.0009765625", POV_BAILOUT[] = "0.0005";

/* Goals for pictures, each compared with one peer; pictures for POV-Ray have the depth of
   tests/peers/pov. */
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
enum { GOALS = sizeof goals / sizeof goals[0] };
static const struct goal own_rays_goal = {1.9, 1.0, false}, level_goal = {1.10, 1.05, false},
                         memory_goal = {110.0, 60.0, false};
static const char own_rays_of[] = "34k";

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

/* Adds a row: the time of `side` divided by that of `other`. `what` and `beside` name the two. */
static void put_ratio(struct table *table, const struct frame *frame, const char *what,
                      enum frame_side side, const char *beside, enum frame_side other,
                      struct goal goal)
{
    static const struct sample_runs none;
    const struct sample_runs *ms = frame->ms;
    struct figure figure = table_ratio(&ms[side], &ms[other], goal);
    json_t *row = document_object();
    snprintf(figure.name, sizeof figure.name, "%s%s : %.16s", frame->name, what, beside);
    document_text(row, "picture", frame->name);
    document_text(row, "level", what[0] ? what + 2 : "watertight");
    document_text(row, "beside", beside);
    document_put(row, "ms", table_times(&ms[side]));
    document_put(row, "beside_ms", table_times(&ms[other]));
    document_put(row, "reference_ms", table_times(&ms[FRAME_REFERENCE]));
    table_row(table);
    table_cell(table, "%s%s", frame->name, what);
    table_cell(table, "%.40s", beside);
    table_ms(table, &ms[side]);
    table_ms(table, &ms[other]);
    table_ms(table, side == FRAME_WHIT ? &ms[FRAME_REFERENCE] : &none);
    table_figure(table, &figure, row);
}

static void put_memory(struct table *table, const char *name, double megabytes)
{
    struct figure figure = {.unit = "MB", .value = megabytes, .goal = memory_goal};
    json_t *row = document_object();
    snprintf(figure.name, sizeof figure.name, "%s, device memory", name);
    document_text(row, "picture", figure.name);
    table_row(table);
    table_cell(table, "%s", figure.name);
    for (int i = 0; i < 4; ++i)
        table_cell(table, "-");
    table_figure(table, &figure, row);
}

static void put_rows(struct table *table, const struct frame *frame)
{
    const struct frame_goal *goal = goal_of(frame->name);
    struct goal none = {0};
    if (frame->ms[FRAME_POV].count)
        put_ratio(table, frame, "", FRAME_WHIT, "POV-Ray", FRAME_POV, goal->goal);
    if (frame->ms[FRAME_AGAINST].count)
        put_ratio(table, frame, "", FRAME_WHIT, path_name(frame->peers->against), FRAME_AGAINST,
                  goal ? goal->goal : none);
    if (frame->ms[FRAME_EMBREE].count)
        put_ratio(table, frame, "", FRAME_WHIT, "Embree, its rays", FRAME_EMBREE, own_rays_goal);
    if (frame->ms[FRAME_EXACT].count) {
        put_ratio(table, frame, ", exact", FRAME_EXACT, "watertight", FRAME_WHIT, level_goal);
        put_ratio(table, frame, ", watertight", FRAME_WHIT, "fast", FRAME_FAST, level_goal);
    }
}

/* ---- One picture ---- */

static void choose_sides(struct frame *frame, bool pov)
{
    const bool takes_part[FRAME_SIDES] = {
        [FRAME_WHIT] = true,
        [FRAME_FAST] = !pov,
        [FRAME_EXACT] = !pov,
        [FRAME_AGAINST] = !pov && frame->peers->against[0],
        [FRAME_POV] = pov,
        [FRAME_REFERENCE] = true,
        [FRAME_EMBREE] = frame->peers->has_embree && strcmp(frame->name, own_rays_of) == 0,
    };
    for (int side = 0; side < FRAME_SIDES; ++side) {
        if (takes_part[side])
            frame->sides[frame->side_count++] = (enum frame_side)side;
    }
}

static whit_result write_pov_scene(const struct frame *frame)
{
    char width[16], height[16], depth[16];
    snprintf(width, sizeof width, "%u", frame->width);
    snprintf(height, sizeof height, "%u", frame->height);
    snprintf(depth, sizeof depth, "%u", frame->depth);
    struct process process = {.program = "sh"};
    process_add(&process, "sh", frame->peers->pov_scenes, frame->name, "colors", width, height,
                depth, frame->bench->folder, NULL);
    return process_run(&process, NULL);
}

static whit_result measure(struct frame *frame, struct table *table, bool pov)
{
    double megabytes = 0.0;
    whit_result result = pov ? write_pov_scene(frame) : WHIT_OK;
    choose_sides(frame, pov);
    if (result == WHIT_OK)
        result = frame_prepare(frame);
    if (result == WHIT_OK && !pov)
        result = frame_memory(frame, &megabytes);
    if (result == WHIT_OK && frame->sides[frame->side_count - 1] == FRAME_EMBREE) {
        result = frame_prepare_rays(frame);
        table_say(table, "Beside Embree %s.", frame->peer.version);
    }
    if (result == WHIT_OK)
        result = frame_run(frame);
    if (result != WHIT_OK)
        return result;
    put_rows(table, frame);
    if (!pov)
        put_memory(table, frame->name, megabytes);
    return bench_step(frame->bench);
}

/* `path`: file of the scene; "": a scene of POV-Ray's. */
static whit_result run_frame(const struct peers *peers, struct table *table, const char *name,
                             const char *path)
{
    struct bench *bench = table->bench;
    const struct frame_goal *goal = goal_of(name);
    bool pov = !path[0], quick = bench->ask.quick;
    struct frame frame = {.bench = bench,
                          .peers = peers,
                          .bailout = pov ? POV_BAILOUT : BAILOUT,
                          .depth = goal ? goal->depth : 8,
                          .width = pov ? bench->ask.width * 3 / 4 : bench->ask.width,
                          .height = bench->ask.height,
                          .small_width = quick ? 0 : 32,
                          .small_height = quick ? 0
                                          : pov ? 24
                                                : 18};
    char file[48];
    snprintf(file, sizeof file, "%s.json", name);
    snprintf(frame.name, sizeof frame.name, "%s", name);
    if (pov)
        bench_file(bench, file, frame.path);
    else
        snprintf(frame.path, sizeof frame.path, "%s", path);
    whit_result result = measure(&frame, table, pov);
    frame_finish(&frame);
    return result;
}

/* ---- The bench ---- */

static void say_how(struct table *table)
{
    const struct bench_request *ask = &table->bench->ask;
    table_say(table,
              "ms: %s a process of its own, less that of a picture 32 wide, caches filled; figure: "
              "times the time of what is beside it. Reference: the same picture in double.",
              table->bench->is_cpu ? "processor time of all threads of"
                                   : "time by the clock, as this device is no CPU, of");
    table_say(
        table,
        "Depth 8, bailout 1/1024, 16 points of an area light, one sample; beside POV-Ray %u x "
        "%u pixels, depth 10 (wine: 2) and bailout 0.0005.",
        ask->width * 3 / 4, ask->height);
}

/* Finds a scene of POV-Ray's, a scene of whit's by its name, or a file. `path` is "" for
   POV-Ray's. */
static whit_result find_scene(const struct bench *bench, const char *word, char name[40],
                              char path[BENCH_PATH])
{
    const char *base = path_name(word), *dot = strrchr(base, '.');
    snprintf(name, 40, "%.*s", (int)(dot ? (size_t)(dot - base) : strlen(base)), base);
    path[0] = 0;
    return is_pov(word) ? WHIT_OK : bench_find(bench, word, path);
}

static whit_result run_words(struct table *table, const char *const *words, uint32_t count)
{
    struct peers peers = {0};
    char name[40], path[BENCH_PATH];
    bool wants_pov = false;
    whit_result result = WHIT_OK;
    for (uint32_t i = 0; result == WHIT_OK && i < count; ++i) {
        result = find_scene(table->bench, words[i], name, path);
        wants_pov = wants_pov || is_pov(words[i]);
    }
    if (result == WHIT_OK)
        result = peers_find_against(&peers, table);
    if (result == WHIT_OK)
        peers_find(&peers, table, wants_pov);
    for (uint32_t i = 0; result == WHIT_OK && i < count; ++i) {
        if (is_pov(words[i]) && !peers.has_pov)
            continue;
        result = find_scene(table->bench, words[i], name, path);
        if (result == WHIT_OK)
            result = run_frame(&peers, table, name, path);
    }
    return result;
}

whit_result bench_frame(struct bench *bench)
{
    static const char *const heads[] = {"picture",    "beside",        "whit, ms",
                                        "beside, ms", "reference, ms", NULL};
    const char *all[GOALS];
    struct table table;
    for (size_t i = 0; i < GOALS; ++i)
        all[i] = goals[i].name;
    const char *const *words = bench->ask.name_count ? bench->ask.names : all;
    uint32_t count = bench->ask.name_count ? bench->ask.name_count : GOALS;
    table_begin(&table, bench, "frame", heads, true, count);
    say_how(&table);
    return table_end(&table, "Whole pictures", run_words(&table, words, count));
}

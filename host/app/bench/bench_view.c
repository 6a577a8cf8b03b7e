/* What it is like to look: `whit view` by replay, in a process of its own, on the display that
   there is. Its states carry the figures. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/bench/bench_section.h"

enum { MOVES = 120, MOVES_QUICK = 8, STEP_MS = 16, IDLE_MS = 5000, IDLE_MS_QUICK = 300 };
static const double BLINK_MS = 100.0; /* a frame that takes longer is seen to */

static whit_result write_replay(const struct bench *bench, const char *path, bool only_first)
{
    FILE *to = fopen(path, "w");
    if (!to) {
        cli_error("%s cannot be written", path);
        return WHIT_ERROR_OUTPUT;
    }
    fprintf(to, "clock real\nstill\nstate first\n");
    for (uint32_t i = 0; i < bench->runs && !only_first; ++i)
        fprintf(to, "wheel 0 %d\nstill\n", i % 2 ? -1 : 1);
    if (!only_first) {
        int moves = bench->quick ? MOVES_QUICK : MOVES;
        fprintf(to, "state whole\nmove 100 100\nbutton left down\n");
        for (int i = 1; i <= moves; ++i)
            fprintf(to, "move %d %d\nwait %d\n", 100 + 3 * i, 100 + i, STEP_MS);
        fprintf(to,
                "button left up\nstate moving\nstill\nwait 300\nstate rest\nwait %d\nstate idle\n",
                bench->quick ? IDLE_MS_QUICK : IDLE_MS);
    }
    if (fclose(to) == 0)
        return WHIT_OK;
    cli_error("%s cannot be written", path);
    return WHIT_ERROR_OUTPUT;
}

/* Runs `whit view`; what it prints goes into the file `out`. */
static whit_result run_viewer(const struct bench *bench, const struct bench_view_case *c,
                              const char *replay, const char *out)
{
    char scene[BENCH_PATH], size[32];
    whit_result result = bench_find(bench, c->scene, scene, sizeof scene);
    if (result != WHIT_OK)
        return result;
    snprintf(size, sizeof size, "%ux%u", bench->width, bench->height);
    const char *arguments[16] = {"whit",    "view",     scene,  "--size",    size,
                                 "--quiet", "--replay", replay, "--no-vsync"};
    int count = 9;
    if (c->depth) {
        arguments[count++] = "--depth";
        arguments[count++] = c->depth;
    }
    if (bench->settings.device[0]) {
        arguments[count++] = "--device";
        arguments[count++] = bench->settings.device;
    }
    const struct bench_child child = {.arguments = arguments, .out = out};
    return bench_child_run(&child, NULL);
}

/* The "measure" of the state with this name, NULL: none. */
static json_t *find_measure(const char *path, const char *name)
{
    json_t *found = NULL, *state = NULL;
    FILE *from = fopen(path, "r");
    while (from && !found && (state = json_loadf(from, JSON_DISABLE_EOF_CHECK, NULL)) != NULL) {
        const char *at = json_string_value(json_object_get(state, "at"));
        if (at && strcmp(at, name) == 0)
            found = json_incref(json_object_get(state, "measure"));
        json_decref(state);
    }
    if (from)
        fclose(from);
    return found;
}

double bench_view_number(const json_t *measure, const char *key, const char *part)
{
    const json_t *value = json_object_get(measure, key);
    return json_number_value(part ? json_object_get(value, part) : value);
}

whit_result bench_view_measure(const struct bench *bench, struct bench_view_case *c,
                               const char *folder)
{
    char replay[BENCH_PATH], out[BENCH_PATH];
    snprintf(replay, sizeof replay, "%s/replay", folder);
    snprintf(out, sizeof out, "%s/states", folder);
    whit_result result = write_replay(bench, replay, true);
    if (result == WHIT_OK)
        result = run_viewer(bench, c, replay, out); /* fills caches */
    if (result == WHIT_OK)
        result = write_replay(bench, replay, false);
    double start_ms = whit_clock_ms();
    if (result == WHIT_OK)
        result = run_viewer(bench, c, replay, out);
    json_t *first = result == WHIT_OK ? find_measure(out, "first") : NULL;
    if (result == WHIT_OK) {
        c->first_ms = bench_view_number(first, "first_ms", NULL) - start_ms;
        c->whole = find_measure(out, "whole");
        c->moving = find_measure(out, "moving");
        c->idle = find_measure(out, "idle");
        if (!first || !c->whole || !c->moving || !c->idle) {
            cli_error("`whit view` did not tell its figures");
            result = WHIT_ERROR_FAILED;
        }
    }
    json_decref(first);
    return result;
}

void bench_view_finish(struct bench_view_case *c)
{
    json_decref(c->whole);
    json_decref(c->moving);
    json_decref(c->idle);
}

static double idle_share(const struct bench_view_case *c)
{
    double ms = bench_view_number(c->idle, "ms", NULL);
    return ms > 0.0 ? bench_view_number(c->idle, "cpu_ms", NULL) / ms : 0.0;
}

static void row(struct section *section, const struct bench_view_case *c)
{
    struct table *table = &section->table;
    double whole_ms = bench_view_number(c->whole, "whole_ms", "median");
    table_row(table);
    table_cell(table, "%s, %s", c->scene, c->label);
    table_cell(table, "%.0f", c->first_ms);
    table_cell(table, "%.1f", whole_ms);
    table_cell(table, "%.1f", whole_ms > 0.0 ? 1e3 / whole_ms : 0.0);
    table_cell(table, "%.1f", bench_view_number(c->moving, "quick_ms", "median"));
    table_cell(table, "1/%.0f", bench_view_number(c->moving, "divisor", "median"));
    table_cell(table, "%.0f, %.0f", bench_view_number(c->moving, "gap_ms", "median"),
               bench_view_number(c->moving, "gap_ms", "max"));
    table_cell(table, "%.0f of %.0f", bench_view_number(c->moving, "gaps_over_100_ms", NULL),
               bench_view_number(c->moving, "gap_ms", "count"));
    table_cell(table, "%.0f, %.0f", bench_view_number(c->moving, "latency_ms", "median"),
               bench_view_number(c->moving, "latency_ms", "p95"));
    table_cell(table, "%.1f", bench_view_number(c->moving, "present_ms", "median"));
    table_cell(table, "%.2f %%", 100.0 * idle_share(c));
}

static void keep(struct section *section, const struct bench_view_case *c)
{
    json_t *object = document_object();
    document_text(object, "case", c->label);
    document_text(object, "scene", c->scene);
    document_ms(object, "first_ms", c->first_ms);
    document_number(object, "idle_share", idle_share(c));
    document_put(object, "whole", json_incref(c->whole));
    document_put(object, "moving", json_incref(c->moving));
    document_put(object, "idle", json_incref(c->idle));
    document_append(section->rows, object);
}

static void say_circumstances(struct section *section)
{
    const struct bench *bench = section->bench;
    double load[1] = {0.0};
    (void)getloadavg(load, 1);
    section_say(
        section,
        "%u x %u. Whole: ms of render by timestamps, %u pictures of all samples; present is "
        "apart. Moving: the camera is dragged, an event every %d ms; pictures are smaller "
        "where that is needed for 30 a second. Wait: from the last input that a picture "
        "shows until it was presented (median, 95 of 100).",
        bench->width, bench->height, bench->runs, STEP_MS);
    section_say(section,
                "First picture: from the command on, caches filled; a smaller one than it becomes. "
                "Over %.0f ms: from one new picture to the next, while moving.",
                BLINK_MS);
    section_say(section, "Load average of this machine at the end: %.1f on %ld cores.", load[0],
                sysconf(_SC_NPROCESSORS_ONLN));
}

whit_result bench_view(struct bench *bench)
{
    static const char *const heads[] = {"scene",
                                        "first, ms",
                                        "whole, ms",
                                        "fps",
                                        "moving, ms",
                                        "size",
                                        "between, ms (median, most)",
                                        "over 100 ms",
                                        "wait, ms",
                                        "present, ms",
                                        "idle, of a core",
                                        NULL};
    struct bench_view_case cases[] = {
        {.scene = "cube", .label = "full"},
        {.scene = "34k", .label = "with shadows", .depth = "0"},
        {.scene = "34k", .label = "full"},
        {.scene = "54k", .label = "full"},
    };
    struct section section;
    char folder[BENCH_SCRATCH];
    whit_result result = bench_scratch_make(folder);
    if (result != WHIT_OK)
        return result;
    section_begin(&section, bench, "view", CASES(cases));
    table_begin(&section.table, heads);
    for (uint32_t i = 0; result == WHIT_OK && i < CASES(cases); ++i) {
        result = cli_cancel ? WHIT_ERROR_CANCELLED : bench_view_measure(bench, &cases[i], folder);
        if (result == WHIT_OK) {
            row(&section, &cases[i]);
            keep(&section, &cases[i]);
        }
        bench_view_finish(&cases[i]);
        bench_step(bench);
    }
    bench_scratch_remove(folder);
    if (result == WHIT_OK)
        say_circumstances(&section);
    return section_end(&section, "The viewer", result);
}

/* `whit bench view`: measures how the viewer responds. Replays input to a `whit view` process on
   the current display, and reads the figures from the states that it prints. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bench/process.h"
#include "bench/table.h"
#include "whit/whit_program.h"

enum { MOVES = 120, MOVES_QUICK = 8, STEP_MS = 16, IDLE_MS = 5000, IDLE_MS_QUICK = 300 };
static const double BLINK_MS = 100.0; /* longer frames are visibly slow */

struct view_case {
    const char *scene, *label, *depth; /* --depth, or NULL */
    uint32_t width, height;
    double first_ms;               /* from the start of the process to the first picture */
    json_t *whole, *moving, *idle; /* "measure" of states */
};

static const char first_lines[] = "clock real\nstill\nstate first\n";

static void put_replay(FILE *to, const void *user)
{
    const struct bench_request *ask = user;
    int moves = ask->quick ? MOVES_QUICK : MOVES;
    fputs(first_lines, to);
    for (uint32_t i = 0; i < ask->runs; ++i)
        fprintf(to, "wheel 0 %d\nstill\n", i % 2 ? -1 : 1);
    fprintf(to, "state whole\nmove 100 100\nbutton left down\n");
    for (int i = 1; i <= moves; ++i)
        fprintf(to, "move %d %d\nwait %d\n", 100 + 3 * i, 100 + i, STEP_MS);
    fprintf(to, "button left up\nstate moving\nstill\nwait 300\nstate rest\nwait %d\nstate idle\n",
            ask->quick ? IDLE_MS_QUICK : IDLE_MS);
}

/* Runs `whit view`; what it prints goes into the file `out`, and an error into the bench's own. */
static whit_result run_viewer(const struct bench *bench, const struct view_case *c,
                              const char *replay, const char *out)
{
    struct process process = {.program = bench->whit, .out = out};
    char scene[BENCH_PATH], messages[BENCH_PATH], size[32];
    bench_file(bench, "messages", messages);
    process.err = messages;
    whit_result result = bench_find(bench, c->scene, scene);
    if (result != WHIT_OK)
        return result;
    snprintf(size, sizeof size, "%ux%u", c->width, c->height);
    process_add(&process, "whit", "view", scene, "--size", size, "--quiet", "--replay", replay,
                "--no-vsync", NULL);
    if (c->depth)
        process_add(&process, "--depth", c->depth, NULL);
    process_add_device(&process, bench);
    return process_run(&process, NULL);
}

static double number_of(const json_t *measure, const char *key, const char *part)
{
    const json_t *value = json_object_get(measure, key);
    return json_number_value(part ? json_object_get(value, part) : value);
}

/* Runs the viewer twice with a replay, first to fill caches, and reads its figures. */
static whit_result measure(const struct bench *bench, struct view_case *c)
{
    char replay[BENCH_PATH], out[BENCH_PATH];
    bench_file(bench, "replay", replay);
    bench_file(bench, "states", out);
    whit_result result = bench_write(bench, "replay", first_lines, sizeof first_lines - 1);
    if (result == WHIT_OK)
        result = run_viewer(bench, c, replay, out); /* fills caches */
    if (result == WHIT_OK)
        result = document_save_written(replay, put_replay, &bench->ask);
    double start_ms = whit_clock_ms();
    if (result == WHIT_OK)
        result = run_viewer(bench, c, replay, out);
    if (result != WHIT_OK)
        return result;
    json_t *first = states_find(out, "first", "measure");
    c->first_ms = number_of(first, "first_ms", NULL) - start_ms;
    c->whole = states_find(out, "whole", "measure");
    c->moving = states_find(out, "moving", "measure");
    c->idle = states_find(out, "idle", "measure");
    if (!first || !c->whole || !c->moving || !c->idle) {
        cli_error("`whit view` did not tell its figures");
        result = WHIT_ERROR_FAILED;
    }
    json_decref(first);
    return result;
}

static double idle_share(const struct view_case *c)
{
    double ms = number_of(c->idle, "ms", NULL);
    return ms > 0.0 ? number_of(c->idle, "cpu_ms", NULL) / ms : 0.0;
}

static double rate_of(double ms)
{
    return ms > 0.0 ? 1e3 / ms : 0.0;
}

static void put_row(struct table *table, const struct view_case *c)
{
    double whole_ms = number_of(c->whole, "whole_ms", "median");
    table_row(table);
    table_cell(table, "%s, %s", c->scene, c->label);
    table_cell(table, "%.0f", c->first_ms);
    table_cell(table, "%.1f", whole_ms);
    table_cell(table, "%.1f", rate_of(whole_ms));
    table_cell(table, "%.1f", number_of(c->moving, "quick_ms", "median"));
    table_cell(table, "1/%.0f", number_of(c->moving, "divisor", "median"));
    table_cell(table, "%.0f, %.0f", number_of(c->moving, "gap_ms", "median"),
               number_of(c->moving, "gap_ms", "max"));
    table_cell(table, "%.0f of %.0f", number_of(c->moving, "gaps_over_100_ms", NULL),
               number_of(c->moving, "gap_ms", "count"));
    table_cell(table, "%.0f, %.0f", number_of(c->moving, "latency_ms", "median"),
               number_of(c->moving, "latency_ms", "p95"));
    table_cell(table, "%.1f", number_of(c->moving, "present_ms", "median"));
    table_cell(table, "%.2f %%", 100.0 * idle_share(c));
    json_t *object = document_object();
    document_text(object, "case", c->label);
    document_text(object, "scene", c->scene);
    document_ms(object, "first_ms", c->first_ms);
    document_number(object, "idle_share", idle_share(c));
    document_put(object, "whole", json_incref(c->whole));
    document_put(object, "moving", json_incref(c->moving));
    document_put(object, "idle", json_incref(c->idle));
    table_keep(table, object);
}

static void say_circumstances(struct table *table)
{
    const struct bench_request *ask = &table->bench->ask;
    double load[1] = {0.0};
    (void)getloadavg(load, 1);
    table_say(table,
              "default: %u x %u. Whole: ms of render by timestamps, all samples; present is apart. "
              "Moving: the camera is dragged, an event every %d ms; "
              "pictures are smaller where that is needed for 30 a second. Wait: from the last "
              "input that a picture shows until it was presented (median, 95 of 100).",
              2 * ask->width, ask->height * 3 / 2, STEP_MS);
    table_say(table,
              "First picture: from the command on, caches filled; a smaller one than it becomes. "
              "Over %.0f ms: from one new picture to the next, while moving.",
              BLINK_MS);
    table_say(table, "Load average of this machine at the end: %.1f on %ld cores.", load[0],
              sysconf(_SC_NPROCESSORS_ONLN));
}

enum { CUBE, SHADOWS_34K, FULL_34K, FULL_54K, DEFAULT, CASES };

static whit_result judge(struct bench *bench, const struct view_case *cases)
{
    static const char *const heads[] = {"viewer", NULL};
    const json_t *whole = cases[FULL_34K].whole, *moving = cases[DEFAULT].moving;
    struct table table;
    table_begin(&table, bench, "view_goals", heads, true, 1);
    table_goal(&table, "viewer", "34k, whole pictures",
               rate_of(number_of(whole, "whole_ms", "median")), "a second",
               (struct goal){8.0, 17.0, true});
    table_goal(&table, "viewer", "default moving, size 1/N", number_of(moving, "divisor", "median"),
               "", (struct goal){6.0, 4.0, false});
    table_goal(&table, "viewer", "default moving", rate_of(number_of(moving, "gap_ms", "median")),
               "a second", (struct goal){30.0, 30.0, true});
    return table_end(&table, "What the viewer must reach", WHIT_OK);
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
    struct view_case cases[CASES] = {
        [CUBE] = {.scene = "cube", .label = "full"},
        [SHADOWS_34K] = {.scene = "34k", .label = "with shadows", .depth = "0"},
        [FULL_34K] = {.scene = "34k", .label = "full"},
        [FULL_54K] = {.scene = "54k", .label = "full"},
        [DEFAULT] = {.scene = "default", .label = "full"},
    };
    struct table table;
    whit_result result = WHIT_OK;
    table_begin(&table, bench, "view", heads, false, CASES);
    for (int i = 0; result == WHIT_OK && i < CASES; ++i) {
        cases[i].width = i == DEFAULT ? 2 * bench->ask.width : bench->ask.width;
        cases[i].height = i == DEFAULT ? bench->ask.height * 3 / 2 : bench->ask.height;
        result = measure(bench, &cases[i]);
        if (result == WHIT_OK) {
            put_row(&table, &cases[i]);
            result = bench_step(bench);
        }
    }
    if (result == WHIT_OK)
        say_circumstances(&table);
    result = table_end(&table, "The viewer", result);
    if (result == WHIT_OK)
        result = judge(bench, cases);
    for (int i = 0; i < CASES; ++i) {
        json_decref(cases[i].whole);
        json_decref(cases[i].moving);
        json_decref(cases[i].idle);
    }
    return result;
}

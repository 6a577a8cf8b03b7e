#include "app/bench/request.h"

#include <string.h>

#include "app/arguments.h"
#include "base/sample.h"
#include "base/text.h"

const struct bench_kind bench_kinds[BENCH_COUNT] = {
    [BENCH_REPORT] = {"report", "the tables of the report that whit comes from, beside its figures",
                      640, 480, .is_single = true},
    [BENCH_BUILD] = {"build", "[MODEL...]: builders beside Embree's: time, memory, quality", 640,
                     480, .takes_names = true, .is_single = true},
    [BENCH_VIEW] = {"view",
                    "the viewer: pictures a second, waits, what it takes when idle; on a display",
                    640, 480, .has_goals = true, .is_single = true},
    [BENCH_RAYS] = {"rays", "[MODEL...]: rays beside Embree's on the same ray files", 1280, 720,
                    .has_goals = true, .takes_names = true},
    [BENCH_FRAME] = {"frame",
                     "[SCENE...]: whole pictures beside POV-Ray, another whit, and the levels",
                     1280, 720, .has_goals = true, .takes_names = true},
    [BENCH_START] = {"start",
                     "the first picture, whole processes with empty caches, beside another whit",
                     320, 240, .has_goals = true},
    [BENCH_SHADERS] =
        {"shaders", "[SCENE...]: what follows a save of a shader in the viewer, on a display; fuel",
         1280, 720, .takes_names = true},
    [BENCH_VIEWS] =
        {"views",
         "[SCENE...]: 4096 views of 64 x 64 drawn together beside one picture of as many pixels",
         4096, 4096, .has_goals = true, .takes_names = true},
    [BENCH_LOOK] = {"look",
                    "MODEL...: how soon the window shows a model that is new to it; on a display",
                    1280, 720, .has_goals = true, .takes_names = true},
};

const struct setting bench_options[] = {
    {"quick", 0, NULL, "tiny pictures and few runs: shows that it works, no more",
     SETTING_AT_FLAG(struct bench_request, quick)},
    {"runs", 0, "N", "of each case, 1 to 99 (7; shaders: 50; quick: 2)",
     SETTING_AT_COUNT(struct bench_request, runs), .min = 1, .max = SAMPLE_RUNS_MAX},
    {"json", 0, "FILE", "also write all figures as JSON",
     SETTING_AT_NAME(struct bench_request, json), .written = true},
    {"scenes", 0, "FOLDER", "where whit's scenes are (./scenes, or beside the program)",
     SETTING_AT_NAME(struct bench_request, scenes)},
    {"naive-limit", 0, NULL, "is gone: `--build sweep` builds the same tree as sweep-naive",
     .kind = SETTING_GONE},
    {"plot", 0, "FILE.svg",
     "rays, frame, start, view, views, look: also draw each row's\n"
     "figure beside its goal",
     SETTING_AT_NAME(struct bench_request, plot), .written = true},
    {"against", 0, "PROGRAM", "frame, start: another whit, timed in turns",
     SETTING_AT_NAME(struct bench_request, against)},
    {"keep", 0, "FOLDER", "rays: leave rays, triangles and hits there",
     SETTING_AT_NAME(struct bench_request, keep)},
    {0},
};

/* BENCH_COUNT where there is no bench of that name, with a message. */
static enum bench_which find_bench(struct cli_reader *reader)
{
    const char *names[BENCH_COUNT];
    for (int i = 0; i < BENCH_COUNT; ++i) {
        names[i] = bench_kinds[i].name;
        if (strcmp(names[i], reader->positional) == 0)
            return (enum bench_which)i;
    }
    const char *nearest = text_nearest(reader->positional, names, BENCH_COUNT);
    if (nearest)
        cli_misuse(reader, "there is no bench `%s`; did you mean `%s`?", reader->positional,
                   nearest);
    else
        cli_misuse(reader, "there is no bench `%s`; `whit bench` lists them", reader->positional);
    return BENCH_COUNT;
}

/* Refuses by cli_misuse, and gives false, where the bench does not take an option or argument. */
static bool check_request(struct cli_reader *reader, const struct bench_request *request)
{
    const struct bench_kind *kind = &bench_kinds[request->which];
    bool has_other = request->which == BENCH_FRAME || request->which == BENCH_START;
    if (!kind->takes_names && request->name_count)
        return cli_misuse(reader, "`%s` is one argument too many", request->names[0]);
    if (request->plot && !kind->has_goals)
        return cli_misuse(reader, "--plot: `whit bench %s` draws none", kind->name);
    if (request->against && !has_other)
        return cli_misuse(reader, "--against is an option of `whit bench frame` and `start`");
    if (request->keep && request->which != BENCH_RAYS)
        return cli_misuse(reader, "--keep is an option of `whit bench rays`");
    for (uint32_t i = 0; i < request->name_count; ++i)
        if (request->which == BENCH_FRAME && strcmp(request->names[i], "viewer") == 0)
            return cli_misuse(reader, "`viewer` is a bench of its own: `whit bench view`");
    return cli_check_output(reader, "--json", request->json,
                            "figures go to a file; tables are printed") &&
           cli_check_output(reader, "--plot", request->plot, "the drawing goes to a file");
}

bool bench_read(struct cli_reader *reader, struct bench_request *request)
{
    *request = (struct bench_request){.which = BENCH_COUNT, .settings = settings_usual()};
    if (!cli_read(reader, request, &request->settings))
        return false;
    if (!reader->positional)
        return true;
    request->which = find_bench(reader);
    request->names = reader->others;
    request->name_count = reader->other_count;
    if (request->which == BENCH_COUNT || !check_request(reader, request))
        return false;
    const struct bench_kind *kind = &bench_kinds[request->which];
    request->width = request->quick ? kind->width / 10 : kind->width;
    request->height = request->quick ? kind->height / 10 : kind->height;
    if (request->runs == 0)
        request->runs = request->quick ? 2 : request->which == BENCH_SHADERS ? 50 : 7;
    return true;
}

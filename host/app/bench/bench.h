/* Benches: cases measured in turns, their figures as tables and as JSON. */
#ifndef APP_BENCH_BENCH_H
#define APP_BENCH_BENCH_H

#include "app/cli.h"
#include "app/document.h"
#include "base/sample.h"

enum { BENCH_NOTES_MAX = 32, BENCH_PATH = 2200, BENCH_SCRATCH = 512, BENCH_GRACE_MS = 3000 };

/* What `whit bench` was asked for, and where its answers go. */
struct bench {
    const char *scenes;       /* the folder, or NULL: where whit finds it */
    const char *json;         /* NULL: text only */
    const char *const *names; /* models or scenes that were asked for */
    uint32_t name_count;
    const char *against, *plot, *keep; /* of benches of speed; or NULL */
    bool quick;
    struct settings settings; /* device, cache, quiet */
    uint32_t runs;
    uint32_t width, height;
    whit_device *device;
    whit_device_info device_info;
    struct cli_progress progress;
    uint32_t step, step_count; /* of the section, for the progress */
    json_t *sections;
};

struct bench_scene {
    whit_scene *scene;
    whit_scene_info info;
    char name[32];
};

struct bench_case {
    const char *label;
    struct bench_scene *scene;
    whit_accel_params accel_params;
    whit_traversal traversal;
    const char *effects;    /* NULL: what the scene calls for */
    uint32_t width, height; /* 0: the bench's */
    whit_accel *accel;
    whit_accel_info accel_info;
    whit_renderer *renderer;
    struct sample_runs build, frame;
    whit_stats counted;
    bool has_counts;
};

/* Where whit's scene of this name is. */
WHIT_CHECK whit_result bench_find(const struct bench *bench, const char *name, char *path,
                                  size_t bytes);
/* `name` without .json. */
WHIT_CHECK whit_result bench_load(const struct bench *bench, const char *name,
                                  struct bench_scene *scene);
WHIT_CHECK whit_result bench_load_file(const char *path, struct bench_scene *scene);
void bench_unload(struct bench_scene *scene);

/* Steps that a section's cases take, for the progress. */
void bench_begin(struct bench *bench, uint32_t steps);
void bench_step(struct bench *bench);
void bench_end(struct bench *bench);

/* Builds each case's trees `runs` times, in turns; the last ones stay. */
WHIT_CHECK whit_result bench_build(struct bench *bench, struct bench_case *cases, uint32_t count,
                                   uint32_t runs);
/* Renders each case's picture, once before the clock counts and then `runs` times, in turns. */
WHIT_CHECK whit_result bench_render(struct bench *bench, struct bench_case *cases, uint32_t count,
                                    uint32_t runs);
/* Renders each once more, with counters. Quick benches count while they are timed, which spares
   pipelines: then this does nothing. */
WHIT_CHECK whit_result bench_count(struct bench *bench, struct bench_case *cases, uint32_t count);
void bench_case_finish(struct bench_case *cases, uint32_t count);

/* 1: `a` takes longer; -1: `b` does; 0: not to be distinguished, as sample_compare says. */
int bench_compare(const struct sample_runs *a, const struct sample_runs *b);
double bench_fps(const struct bench_case *c);
/* Nodes opened a ray (pairs, leaves, instances), over all rays. */
double bench_visits(const struct bench_case *c);
double bench_triangle_tests(const struct bench_case *c);
json_t *bench_document(const struct bench_case *c);

/* ---- Children (bench_child.c) ---- */

/* A folder of its own below TMPDIR. */
WHIT_CHECK whit_result bench_scratch_make(char folder[BENCH_SCRATCH]);
void bench_scratch_remove(const char *folder); /* with all that is in it */

struct bench_child {
    const char *program;          /* NULL: whit */
    const char *const *arguments; /* from its name on, ended by NULL */
    const char *folder;           /* that it works in; NULL: here */
    bool is_tried;                /* what goes wrong is not said */
    const char *out, *err; /* files that take what it prints; NULL: it prints where whit does */
};
struct bench_child_times {
    double cpu_ms; /* all its threads and children took */
    double clock_ms;
};
/* Waits for its end: an error unless that was exit code 0. `times` may be NULL. */
WHIT_CHECK whit_result bench_child_run(const struct bench_child *child,
                                       struct bench_child_times *times);

/* ---- Tables ---- */

enum { TABLE_COLUMNS_MAX = 12, TABLE_ROWS_MAX = 64, TABLE_CELL = 56 };
struct table {
    uint32_t column_count, row_count, cell;
    bool is_open; /* a line ends in its last cell, without a rule behind it */
    char cells[TABLE_ROWS_MAX][TABLE_COLUMNS_MAX][TABLE_CELL];
};
/* Heads of columns, ended by NULL. */
void table_begin(struct table *table, const char *const *heads);
void table_row(struct table *table);
void table_cell(struct table *table, const char *format, ...) WHIT_PRINTF(2, 3);
void table_ms(struct table *table, const struct sample_runs *times);
/* As Markdown, aligned: the first column to the left, all others to the right. */
void table_print(const struct table *table);

/* ---- The viewer (bench_view.c) ---- */

struct bench_view_case {
    const char *scene, *label, *depth; /* --depth, or NULL */
    double first_ms;                   /* from the command to the first picture */
    json_t *whole, *moving, *idle;     /* "measure" of states */
};
/* By replay, in a process of its own, in the bench's size, on the display that there is. */
WHIT_CHECK whit_result bench_view_measure(const struct bench *bench, struct bench_view_case *c,
                                          const char *folder);
void bench_view_finish(struct bench_view_case *c);
double bench_view_number(const json_t *measure, const char *key, const char *part);

/* ---- The benches ---- */

whit_result bench_report(struct bench *bench);
whit_result bench_view(struct bench *bench);
/* tools/bench/: rays beside Embree; whole pictures beside POV-Ray, another whit and more. */
whit_result bench_rays(struct bench *bench);
whit_result bench_frame(struct bench *bench);
/* The first picture beside another whit. */
whit_result bench_start(struct bench *bench);

#endif

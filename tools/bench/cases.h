/* Scenes with trees of some kind, drawn and counted in turns. */
#ifndef BENCH_CASES_H
#define BENCH_CASES_H

#include "bench/bench.h"

struct bench_case {
    const char *label, *scene; /* by its name; neighbours with the same one share it */
    whit_accel_params accel_params;
    whit_traversal traversal;
    whit_shadows shadows;
    uint32_t shrink;             /* its picture has 1/shrink of width and height; 0: all */
    double report_s, report_fps; /* what the report says; 0: nothing */
    struct bench_scene loaded;
    uint32_t width, height;
    whit_accel *accel;
    whit_accel_info accel_info;
    whit_renderer *renderer;
    struct sample_runs build, frame; /* ms */
    whit_stats counted;
};

WHIT_CHECK whit_result cases_load(const struct bench *bench, struct bench_case *cases,
                                  uint32_t count);
/* Its trees, once, in place of those that it has. */
WHIT_CHECK whit_result case_build(struct bench_case *c);
/* Builds each case's trees as often as the bench has runs, in turns; the last ones stay. */
WHIT_CHECK whit_result cases_build(struct bench *bench, struct bench_case *cases, uint32_t count);
/* Renders each case's picture, once before the clock counts and then as often, in turns; and once
   more with counters. Quick benches count while they are timed, which spares pipelines. */
WHIT_CHECK whit_result cases_draw(struct bench *bench, struct bench_case *cases, uint32_t count);
/* What cases_draw makes of the progress for each case. */
uint32_t cases_steps(const struct bench *bench);
void cases_finish(struct bench_case *cases, uint32_t count);

/* Figures of cases_draw; 0 without. */
double case_fps(const struct bench_case *c);
/* Nodes opened a ray (pairs, leaves, instances), over all rays; triangles tested a ray. */
double case_visits(const struct bench_case *c);
double case_triangle_tests(const struct bench_case *c);
/* The depth of the deepest level whose boxes a camera ray looked at, its mean over camera rays. */
double case_depth_mean(const struct bench_case *c);
json_t *case_document(const struct bench_case *c);

#endif

/* Cases: scenes with a kind of tree, timed and counted in turns. */
#ifndef BENCH_CASES_H
#define BENCH_CASES_H

#include "bench/bench.h"

struct bench_case {
    const char *label, *scene; /* scene: its name; neighbouring cases with the same name share the
                                  scene */
    whit_accel_params accel_params;
    whit_traversal traversal;
    whit_shadows shadows;
    uint32_t shrink;             /* its picture has 1/shrink of width and height; 0: the full
                                    size */
    double report_s, report_fps; /* figures of the report that whit started from; 0: none */
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
/* Builds the case's trees once, in place of those that it has. */
WHIT_CHECK whit_result case_build(struct bench_case *c);
/* Builds the trees of all cases in turns, as often as the bench has runs; the last trees stay. */
WHIT_CHECK whit_result cases_build(struct bench *bench, struct bench_case *cases, uint32_t count);
/* Renders the pictures of all cases in turns, once as a warm-up and then as often as the bench has
   runs, and once more with counters. Quick benches count during the timed runs, which needs fewer
   pipelines. */
WHIT_CHECK whit_result cases_draw(struct bench *bench, struct bench_case *cases, uint32_t count);
/* The number of progress steps of cases_draw per case. */
uint32_t cases_steps(const struct bench *bench);
void cases_finish(struct bench_case *cases, uint32_t count);

/* Figures from cases_draw; 0 before it. */
double case_fps(const struct bench_case *c);
/* Nodes opened (inner nodes, leaves, instances) and triangles tested, per ray, over all rays. */
double case_visits(const struct bench_case *c);
double case_triangle_tests(const struct bench_case *c);
/* The deepest level of the trees whose boxes a camera ray tested, as mean over camera rays. */
double case_depth_mean(const struct bench_case *c);
json_t *case_document(const struct bench_case *c);

#endif

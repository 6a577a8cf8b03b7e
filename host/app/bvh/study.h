/* The measurements of `whit bvh`: builders side by side, on the CPU and on a device. */
#ifndef APP_BVH_STUDY_H
#define APP_BVH_STUDY_H

#include "app/job.h"
#include "base/sample.h"

enum { STUDY_ROWS_MAX = 32, STUDY_THREADS_MAX = 16, STUDY_RUNS_MAX = 1000 };
enum study_kind { STUDY_PRIMARY, STUDY_SHADOW, STUDY_DIFFUSE, STUDY_KINDS };

struct study_row {
    char name[96]; /* the builder, as builder_write gives it */
    whit_accel *accel;
    whit_renderer *renderer; /* NULL: not traced */
    whit_accel_info info;
    whit_accel_report report;
    struct sample_summary build_ms[STUDY_THREADS_MAX], mrays_per_s[STUDY_KINDS];
};

struct study_rays {
    whit_ray *rays;
    uint32_t count;
};

struct study {
    struct job job;
    struct study_row rows[STUDY_ROWS_MAX];
    uint32_t threads[STUDY_THREADS_MAX];
    uint32_t row_count, thread_count, run_count, ray_count;
    bool validate, json, no_trace;

    struct cli_progress progress;
    uint32_t steps, steps_done;
    double *times_ms; /* of builds, [list][run]; a list is a row with a number of threads */
    struct study_rays rays[STUDY_KINDS];
    uint64_t compared, differing; /* numbers of hits */
    bool traced;
};

extern const char *const study_kind_names[STUDY_KINDS]; /* "primary" */
/* Counts one of study->steps as done. An error where the time limit has passed or the user stopped
   the program. */
whit_result study_step(struct study *study);

/* Builds every row with every number of threads, in turns (study.c). */
whit_result study_build(struct study *study);
/* Validates the trees where asked for, and makes their reports. */
whit_result study_report(struct study *study);
/* Traces the same rays through all rows, in turns, and compares their hits; WHIT_ERROR_STATUS where
   hits differ (study_trace.c). Needs an open device. */
whit_result study_trace(struct study *study);
void study_finish(struct study *study);

/* On standard output (study_output.c). */
int study_print(const struct study *study);

#endif

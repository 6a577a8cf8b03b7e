/* What all benches of whit-bench share. */
#ifndef BENCH_BENCH_H
#define BENCH_BENCH_H

#include "app/bench/request.h"
#include "app/document.h"
#include "base/sample.h"

enum { BENCH_PATH = 2200, BENCH_GRACE_MS = 3000 };

struct bench {
    struct bench_request ask;
    const char *whit; /* the program */
    whit_device *device;
    whit_device_info device_info;
    bool is_cpu;             /* the device: times are those of the processor, else by the clock */
    char folder[BENCH_PATH]; /* for files: --keep, or it is removed at the end */
    struct cli_progress progress;
    uint32_t step, step_count; /* of the table at hand */
    bool has_head;             /* what is above the first table is printed */
    json_t *tables;
};

/* One more of the table's steps; an error when the user stopped it. */
WHIT_CHECK whit_result bench_step(struct bench *bench);
/* Where whit's scene of this name is, `name` without .json: from the root on. */
WHIT_CHECK whit_result bench_find(const struct bench *bench, const char *name,
                                  char path[BENCH_PATH]);
void bench_file(const struct bench *bench, const char *name, char path[BENCH_PATH]);
WHIT_CHECK whit_result bench_write(const struct bench *bench, const char *name, const void *data,
                                   size_t bytes);

struct bench_scene {
    whit_scene *scene;
    whit_scene_info info;
};
WHIT_CHECK whit_result bench_load(const char *path, struct bench_scene *scene);
void bench_unload(struct bench_scene *scene);

/* ---- Programs that a bench runs (process.c) ---- */

enum { PROCESS_ARGUMENTS = 40 };
struct process {
    const char *program;
    const char *arguments[PROCESS_ARGUMENTS]; /* from its name on: process_add */
    uint32_t argument_count;
    const char *folder;    /* that it works in; NULL: here */
    bool is_tried;         /* what goes wrong is not said */
    const char *out, *err; /* files that take what it prints; NULL: it prints where whit does */
    int socket;            /* in their place its input and its output; 0: none */
    int pid;               /* while it runs */
};
struct process_times {
    double cpu_ms; /* all its threads and children took */
    double clock_ms;
};
/* Texts, ended by NULL, which outlive the process. */
void process_add(struct process *process, ...) __attribute__((sentinel));
/* The device that the bench is asked for, as an option of whit. */
void process_add_device(struct process *process, const struct bench *bench);
WHIT_CHECK whit_result process_start(struct process *process);
/* Waits for its end: an error unless that was exit code 0. `times` may be NULL. */
WHIT_CHECK whit_result process_end(struct process *process, struct process_times *times);
WHIT_CHECK whit_result process_run(struct process *process, struct process_times *times);
void process_remove_folder(const char *folder); /* with all that is in it */

/* ---- The benches ---- */

whit_result bench_report(struct bench *bench);
whit_result bench_build(struct bench *bench);
whit_result bench_view(struct bench *bench);
whit_result bench_rays(struct bench *bench);
whit_result bench_frame(struct bench *bench);
whit_result bench_start(struct bench *bench);
whit_result bench_shaders(struct bench *bench);
whit_result bench_views(struct bench *bench);

#endif

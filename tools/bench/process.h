/* Programs that a bench runs. */
#ifndef BENCH_PROCESS_H
#define BENCH_PROCESS_H

#include "bench/bench.h"

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

#endif

/* Programs that a bench runs. */
#ifndef BENCH_PROCESS_H
#define BENCH_PROCESS_H

#include "bench/bench.h"

enum { PROCESS_ARGUMENTS = 40 };
struct process {
    const char *program;
    const char *arguments[PROCESS_ARGUMENTS]; /* its name and arguments, added by process_add */
    uint32_t argument_count;
    const char *folder;    /* its working folder; NULL: that of the bench */
    bool is_tried;         /* errors are not printed */
    const char *out, *err; /* files for its standard output and error; NULL: inherited */
    int socket;            /* used as its input and output in place of files; 0: none */
    int pid;               /* its process id while it runs */
};
struct process_times {
    double cpu_ms; /* processor time of all its threads and children */
    double clock_ms;
};
/* Adds arguments, ended by NULL; they must outlive the process. */
void process_add(struct process *process, ...) __attribute__((sentinel));
/* Adds the bench's device as an option of whit. */
void process_add_device(struct process *process, const struct bench *bench);
WHIT_CHECK whit_result process_start(struct process *process);
/* Waits until the process ends; an error unless its exit code is 0. `times` may be NULL. */
WHIT_CHECK whit_result process_end(struct process *process, struct process_times *times);
WHIT_CHECK whit_result process_run(struct process *process, struct process_times *times);
void process_remove_folder(const char *folder); /* with all that is in it */

#endif
